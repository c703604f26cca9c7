// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/device_texture.h"

namespace eyrie::draw {

std::uint64_t textureBytes(const terrain::TexturePyramid& pyramid, const terrain::TextureId& tile,
                           TextureFormat format) {
    const std::uint64_t perBlock = format == TextureFormat::Bc1
                                       ? sizeof(terrain::Bc1Block)
                                       : sizeof(fabric::Rgba) * terrain::BlockTexels().size();
    return perBlock * static_cast<std::uint64_t>(pyramid.blocksX(tile)) *
           static_cast<std::uint64_t>(pyramid.blocksY(tile));
}

TextureImage::TextureImage(const terrain::TexturePage& page, TextureFormat format)
    : blocksX_(page.blocksX()), blocksY_(page.blocksY()) {
    if (format == TextureFormat::Bc1) {
        blocks_.assign(page.blocks().begin(), page.blocks().end());
        return;
    }
    texels_.resize(page.blocks().size() * terrain::BlockTexels().size());
    terrain::decodeBc1(page.blocks(), page.blocksX(), texels_);
}

DeviceTexture::DeviceTexture(const TextureImage& image) {
    const GLsizei width = image.blocksX_ * terrain::kBlockSide;
    const GLsizei height = image.blocksY_ * terrain::kBlockSide;
    if (image.texels_.empty()) {
        constexpr GLenum kFormat = GL_COMPRESSED_RGBA_S3TC_DXT1_EXT;
        glTextureStorage2D(texture_.id(), 1, kFormat, width, height);
        glCompressedTextureSubImage2D(
            texture_.id(), 0, 0, 0, width, height, kFormat,
            static_cast<GLsizei>(image.blocks_.size() * sizeof(terrain::Bc1Block)),
            image.blocks_.data());
    } else {
        glTextureStorage2D(texture_.id(), 1, GL_RGBA8, width, height);
        glTextureSubImage2D(texture_.id(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                            image.texels_.data());
    }
    setFilter();
}

DeviceTexture::DeviceTexture() {
    const fabric::Rgba hole{0, 0, 0, 0};
    glTextureStorage2D(texture_.id(), 1, GL_RGBA8, 1, 1);
    glTextureSubImage2D(texture_.id(), 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &hole);
    setFilter();
}

void DeviceTexture::setFilter() {
    glTextureParameteri(texture_.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(texture_.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(texture_.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture_.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace eyrie::draw
