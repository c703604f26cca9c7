// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/channel_program.h"
#include "fabric/image.h"

namespace eyrie::fabric {

/// The framebuffer of a channel while a frame is put together in it: `area` of background with
/// depth 0 at first. Holds no more pixels than were drawn (a rectangle around them), so that
/// merging and sending cost what is there.
class ChannelBuffer {
public:
    ChannelBuffer(const PixelViewport& area, Rgba background, bool hasDepth)
        : area_(area), background_(background), hasDepth_(hasDepth) {}

    /// Puts in a picture of `whole`, of which `image` is the covered part, the rest background.
    /// Preconditions: area contains `whole`, that contains image.area; to merge by depth both the
    /// image (unless empty) and this have it. Pasted without depth it gets depth 0 here.
    void put(Image image, const PixelViewport& whole, Merge merge);

    /// What is there of `part`: its covered part, the rest is background. With depth only if this
    /// has it.
    Image part(const PixelViewport& part, bool withDepth) const;

private:
    /// Makes room for pixels of `area`.
    void cover(const PixelViewport& area);
    /// Puts background where there are pixels.
    void clear(const PixelViewport& area);

    const PixelViewport area_;
    const Rgba background_;
    const bool hasDepth_;
    Image pixels_;
};

}  // namespace eyrie::fabric
