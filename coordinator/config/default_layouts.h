// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "coordinator/config/configuration.h"

/// Trees of compounds for renderers of these weights, each above 0, one channel each. The first
/// channel is the destination's; the root has no channel yet.
namespace eyrie::config {

/// channel1 and so on.
std::string channelName(std::size_t index);

/// Sort-first: parts of the picture.
Compound parts(std::span<const double> weights);

/// Sort-last: ranges of the data.
Compound ranges(std::span<const double> weights);

/// Sort-last in which each channel merges a strip of the picture of what all others drew. After
/// Stompel, Ma, Lum, Ahrens, Patchett: "SLIC: Scheduled Linear Image Compositing" (2003), without
/// its schedule; Eilemann, Pajarola: "Direct Send Compositing for Parallel Sort-Last Rendering"
/// (2007).
Compound directSend(std::span<const double> weights);

/// Ranges of the data for groups of as many as there are groups, about; in each parts of the
/// picture.
Compound rangesOfParts(std::span<const double> weights);

/// With a load equalizer at its root.
Compound balanced(Compound root, SplitMode mode);

}  // namespace eyrie::config
