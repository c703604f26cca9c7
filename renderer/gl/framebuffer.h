// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <absl/status/status.h>

#include "fabric/delivery.h"
#include "fabric/image.h"
#include "renderer/gl/object.h"

namespace eyrie::gl {

/// Memory of the host that the device copies depths to: on a GPU in a third of the time that it
/// takes to memory of ours, and all of a picture's in that of six pixels'.
class MappedDepth {
public:
    explicit MappedDepth(std::size_t pixels);

    std::size_t size() const { return pixels_; }
    GLuint id() const { return buffer_.id(); }
    /// What is there once the device has finished: nothing, infinitely far, if it has no memory.
    std::span<const float> first(std::size_t pixels);

private:
    Buffer buffer_;
    std::size_t pixels_;
    const float* mapped_;
    std::vector<float> nothing_;
};

/// Colour (RGBA8) and reversed depth (32-bit float) of one view.
///
/// It is always as large as the whole view, and a channel draws into its part of it under a
/// scissor. A shifted viewport would round window coordinates differently from the whole view's
/// and so move edges by a subpixel: this way every channel rasterises the same bits.
class Framebuffer {
public:
    /// Makes the framebuffer at least as large as the view. ResourceExhausted when the device
    /// refuses.
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
