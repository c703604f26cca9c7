// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "renderer/gl/object.h"

namespace eyrie::gl {

/// Host memory that the device writes depths to by itself, as a pixel pack buffer: on a GPU in a
/// third of the time of other memory, and nobody copies them (docs/benchmarks/gpu.md). GL thread.
class MappedDepth {
public:
    explicit MappedDepth(std::size_t pixels);

    GLuint id() const { return buffer_.id(); }
    std::size_t size() const { return pixels_; }  ///< in pixels
    bool isMapped() const { return mapped_ != nullptr; }

    /// What the device has written, once it has finished: valid as long as this. Where there was no
    /// memory for it, which takeGlError() tells, nothing was drawn: 0, infinitely far.
    std::span<const float> first(std::size_t pixels) const;

private:
    Buffer buffer_;
    std::size_t pixels_;
    const float* mapped_;
    std::vector<float> nothing_;
};

}  // namespace eyrie::gl
