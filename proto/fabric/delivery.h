// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <stop_token>

#include "fabric/image.h"

namespace eyrie::fabric {

/// Memory for the pixels of a picture, as Image has them: large enough, of any bits.
struct PixelRoom {
    Rgba* colour = nullptr;
    float* depth = nullptr;  ///< null where no depth is asked for
};

/// How a channel's picture is to come about and where it goes, which changes none of its pixels.
/// What is called is called by the thread that draws.
struct Delivery {
    std::stop_token stop = {};  ///< ends it, as Cancelled

    /// Called once at most, when all is handed to the device and most of it is drawn: another task
    /// that comes now need not wait for long, nor does the device for it.
    std::function<void()> nearlyDrawn = {};

    /// Where the pixels of `area` are to go in place of the result's image, which then has an area
    /// and no pixels. Asked once at most, when they are there; nothing: they go into the image.
    std::function<std::optional<PixelRoom>(const PixelViewport& area, bool withDepth)> room = {};
};

}  // namespace eyrie::fabric
