// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Where a channel is in its window, and how large.
fabric::PixelViewport pixelsOf(const Configuration& configuration, const ChannelIndex& index);

/// Of a whole canvas, by its first segment that has a channel; nothing where none has.
std::optional<PixelSize> configuredSize(const Configuration& configuration, const Canvas& canvas);

/// One for each view of each layout of a canvas and each segment that it falls on.
std::vector<Destination> destinationsOf(const Configuration& configuration, const Display& display,
                                        Findings& findings);

/// The eyes' places, metres: left, right, and between them. Those of the view's observer, or the
/// usual ones.
struct EyePlaces {
    fabric::Vec3 cyclop{0, 0, 0};
    fabric::Vec3 left{0, 0, 0};
    fabric::Vec3 right{0, 0, 0};
};
EyePlaces eyePlaces(const Configuration& configuration, const View& view);

}  // namespace eyrie::config
