// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fabric/channel_task.h"

namespace eyrie::coordinator {

/// How one frame is cut into channels for several renderers.
enum class Decomposition {
    TwoD,  ///< sort-first: each draws a part of the picture
    Db,    ///< sort-last: each draws a share of the data, composited by depth
};

/// `whole` cut at `cuts` (positions in (0, 1), ascending) into one task more than there are cuts,
/// or fewer where there are not that many pixels; in the order in which they are to be assembled.
///
/// 2D cuts the picture along its longer side, which keeps the parts near square and so the LOD
/// nodes that two of them share few. DB cuts the range and needs depth, so every task asks for it.
/// No cuts: `whole` itself.
std::vector<fabric::ChannelTask> decompose(const fabric::ChannelTask& whole,
                                           Decomposition decomposition,
                                           std::span<const double> cuts);

}  // namespace eyrie::coordinator
