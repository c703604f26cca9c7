// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/config/configuration.h"

namespace eyrie::config {

/// The swap barriers of a canvas's screens, by name; empty: none.
struct CanvasBarriers {
    std::string whole;                  ///< of the whole canvas in one picture
    std::vector<std::string> segments;  ///< of each by itself

    bool operator==(const CanvasBarriers&) const = default;
};

/// A segment has the barrier that it names, else its canvas's, else that of the compound that makes
/// its picture in `layout`, or of the nearest above that one. The whole canvas has its own, else
/// the one that all its segments share. What has no name is one for a canvas and its segments, and
/// one for all compounds of a root (as Equalizer has it, `eq::server::Compound::setSwapBarrier`):
/// `swapbarrier {}` in each screen of a wall joins them.
CanvasBarriers swapBarriers(const Configuration& configuration, std::size_t canvas,
                            const std::optional<std::size_t>& layout);

}  // namespace eyrie::config
