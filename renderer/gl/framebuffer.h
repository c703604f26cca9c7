// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <absl/status/status.h>

#include "fabric/delivery.h"
#include "fabric/image.h"
#include "renderer/gl/mapped_depth.h"
#include "renderer/gl/object.h"

namespace eyrie::gl {

/// Colour (RGBA8) and reversed depth (32-bit float) of one view.
///
/// It is always as large as the whole view, and a channel draws into its part of it under a
/// scissor. A shifted viewport would round window coordinates differently from the whole view's
/// and so move edges by a subpixel: this way every channel rasterises the same bits.
class Framebuffer {
public:
    /// Makes the framebuffer at least as large as the view. ResourceExhausted when the device
    /// refuses, which holds for this view only. Takes the errors of GL: who wants to know of
    /// earlier ones asks before.
    absl::Status resize(int width, int height);

    /// Binds it, restricts drawing to `part` and clears that part.
    void begin(int viewWidth, int viewHeight, const fabric::PixelViewport& part,
               fabric::Rgba background);

    /// Reads `part` back, depth only where asked for; waits for drawing to finish.
    fabric::Image read(const fabric::PixelViewport& part, bool withDepth);

    /// The same into `room`.
    void read(const fabric::PixelViewport& part, const fabric::PixelRoom& room);

    /// The depth of `part` so far, as fabric::Image has it; waits for drawing. Drawing may go on.
    /// Nothing is copied on the host: valid until the next call.
    std::span<const float> depth(const fabric::PixelViewport& part);

private:
    FramebufferObject framebuffer_;
    Renderbuffer colour_;
    Renderbuffer depth_;
    int width_ = 0;
    int height_ = 0;
    std::optional<MappedDepth> depths_;  ///< as large as was needed so far
};

}  // namespace eyrie::gl
