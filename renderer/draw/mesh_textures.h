// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/draw/device_texture.h"
#include "renderer/gl/object.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

/// The images of a mesh on the device, filtered trilinearly. GL thread.
class MeshTextures {
public:
    /// Reads all images of `file`; where they would take more than `deviceBytes`, without their
    /// finest levels, of all images as many. An image that is damaged is logged, and its mean
    /// colour stands for it. Errors: Unavailable (an image could not be read).
    static absl::StatusOr<MeshTextures> read(const mesh::EymFile& file, std::uint64_t deviceBytes,
                                             TextureFormat format);

    /// Of all images of `file` with all their levels.
    static std::uint64_t allBytes(const mesh::EymFile& file, TextureFormat format);

    /// Precondition: image < file.images().size().
    const gl::Texture2D& texture(std::int32_t image) const {
        return textures_[static_cast<std::size_t>(image)];
    }
    std::uint64_t bytes() const { return bytes_; }
    /// Those whose mean colour stands for them, ascending.
    const std::vector<std::int32_t>& damaged() const { return damaged_; }

private:
    explicit MeshTextures(std::size_t images) : textures_(images) {}

    std::vector<gl::Texture2D> textures_;
    std::vector<std::int32_t> damaged_;
    std::uint64_t bytes_ = 0;
};

}  // namespace eyrie::draw
