// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "fabric/image.h"
#include "renderer/gl/object.h"
#include "renderer/terrain/imagery/texture_page.h"
#include "renderer/terrain/imagery/texture_pyramid.h"

namespace eyrie::draw {

/// How texture tiles lie on a device.
enum class TextureFormat {
    Bc1,   ///< where the device reads blocks in hardware
    Rgba8  ///< software renderers are 1.7 times as fast with it
};

/// Bytes of a texture tile in memory, host or device.
std::uint64_t textureBytes(const terrain::TexturePyramid& pyramid, const terrain::TextureId& tile,
                           TextureFormat format);

/// A texture tile made ready for the device, on a loader's thread: blocks, or the texels they
/// decode to.
class TextureImage {
public:
    TextureImage(const terrain::TexturePage& page, TextureFormat format);

private:
    friend class DeviceTexture;

    std::int32_t blocksX_;
    std::int32_t blocksY_;
    std::vector<terrain::Bc1Block> blocks_;  ///< either these
    std::vector<fabric::Rgba> texels_;       ///< or these
};

/// A texture tile on the device: filtered, without coarser levels of its own. GL thread.
class DeviceTexture {
public:
    explicit DeviceTexture(const TextureImage& image);
    /// One texel that is a hole.
    DeviceTexture();

    const gl::Texture2D& texture() const { return texture_; }

private:
    void setFilter();

    gl::Texture2D texture_;
};

}  // namespace eyrie::draw
