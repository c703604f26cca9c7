// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/box.h"
#include "fabric/viewport.h"
#include "renderer/draw/drawable.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// What a channel sees of boxes of an object, as far as that is known at little cost.
class SeenBoxes {
public:
    /// `view` outlives it. Lines have a width: of wireframes all is seen.
    SeenBoxes(const lod::ObjectView& view, const FrameState& frame)
        : view_(view),
          channel_(frame.channel),
          isKnown_(frame.shading != fabric::Shading::Wireframe) {}

    /// Not so for certain of what reaches the edge of the view, and maybe beyond.
    bool seesAll(const fabric::Box& bounds) const {
        const fabric::PixelViewport pixels = view_.coveredPixels(bounds);
        const fabric::PixelViewport inside{1, 1, view_.view().width - 2, view_.view().height - 2};
        return !isKnown_ || (channel_.contains(pixels) && inside.contains(pixels));
    }
    /// False only if nothing of it is drawn.
    bool sees(const fabric::Box& bounds) const {
        return !isKnown_ || !intersection(view_.coveredPixels(bounds), channel_).isEmpty();
    }

private:
    const lod::ObjectView& view_;
    const fabric::PixelViewport channel_;
    const bool isKnown_;
};

}  // namespace eyrie::draw
