// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_textures.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "fabric/log.h"
#include "renderer/mesh/image_codec.h"

namespace eyrie::draw {
namespace {

/// Of levels from `first` on.
std::uint64_t deviceBytes(const mesh::ImageShape& shape, std::uint32_t first,
                          TextureFormat format) {
    if (format == TextureFormat::Bc1)
        return shape.bytesFrom(first);
    std::uint64_t texels = 0;
    for (std::uint32_t level = first; level < shape.levels(); ++level)
        texels += std::uint64_t{shape.widthAt(level)} * shape.heightAt(level);
    return texels * sizeof(fabric::Rgba);
}

/// Of all images without their `drop` finest levels, but for the last of each.
std::uint64_t bytesWithout(std::uint32_t drop, std::span<const mesh::ImageRecord> images,
                           TextureFormat format) {
    std::uint64_t bytes = 0;
    for (const mesh::ImageRecord& image : images)
        bytes += deviceBytes(image.shape, std::min(drop, image.shape.levels() - 1), format);
    return bytes;
}

/// The least number of finest levels without which all images fit, or nothing is left to drop.
std::uint32_t levelsToDrop(std::span<const mesh::ImageRecord> images, std::uint64_t mostBytes,
                           TextureFormat format) {
    std::uint32_t mostLevels = 1;
    for (const mesh::ImageRecord& image : images)
        mostLevels = std::max(mostLevels, image.shape.levels());
    for (std::uint32_t drop = 0;; ++drop)
        if (drop + 1 == mostLevels || bytesWithout(drop, images, format) <= mostBytes)
            return drop;
}

void setFilter(const gl::Texture2D& texture, const mesh::ImageShape& shape) {
    const auto wrap = [&](std::uint32_t clamps) {
        return (shape.flags & clamps) != 0 ? GL_CLAMP_TO_EDGE : GL_REPEAT;
    };
    glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, wrap(mesh::kClampsU));
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, wrap(mesh::kClampsV));
}

void uploadTexels(const gl::Texture2D& texture, const mesh::ImageShape& shape,
                  std::span<const std::byte> blocks, std::uint32_t first) {
    const auto levels = static_cast<GLsizei>(shape.levels() - first);
    glTextureStorage2D(texture.id(), levels, GL_RGBA8, static_cast<GLsizei>(shape.widthAt(first)),
                       static_cast<GLsizei>(shape.heightAt(first)));
    for (GLint k = 0; k < levels; ++k) {
        const std::uint32_t level = first + static_cast<std::uint32_t>(k);
        const auto width = static_cast<GLsizei>(shape.widthAt(level));
        const std::vector<fabric::Rgba> texels = mesh::decodeLevel(shape, blocks, level);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, (width + 3) / 4 * 4);
        glTextureSubImage2D(texture.id(), k, 0, 0, width,
                            static_cast<GLsizei>(shape.heightAt(level)), GL_RGBA, GL_UNSIGNED_BYTE,
                            texels.data());
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

void uploadBlocks(const gl::Texture2D& texture, const mesh::ImageShape& shape,
                  std::span<const std::byte> blocks, std::uint32_t first) {
    const GLenum format =
        shape.hasAlpha() ? GL_COMPRESSED_RGBA_S3TC_DXT5_EXT : GL_COMPRESSED_RGB_S3TC_DXT1_EXT;
    const auto levels = static_cast<GLsizei>(shape.levels() - first);
    glTextureStorage2D(texture.id(), levels, format, static_cast<GLsizei>(shape.widthAt(first)),
                       static_cast<GLsizei>(shape.heightAt(first)));
    for (GLint k = 0; k < levels; ++k) {
        const std::uint32_t level = first + static_cast<std::uint32_t>(k);
        const std::uint64_t offset = shape.bytesFrom(0) - shape.bytesFrom(level);
        const std::uint64_t bytes = shape.bytesFrom(level) - shape.bytesFrom(level + 1);
        glCompressedTextureSubImage2D(texture.id(), k, 0, 0,
                                      static_cast<GLsizei>(shape.widthAt(level)),
                                      static_cast<GLsizei>(shape.heightAt(level)), format,
                                      static_cast<GLsizei>(bytes), blocks.data() + offset);
    }
}

void uploadMean(const gl::Texture2D& texture, const mesh::ImageShape& shape) {
    glTextureStorage2D(texture.id(), 1, GL_RGBA8, 1, 1);
    glTextureSubImage2D(texture.id(), 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &shape.meanColour);
}

}  // namespace

std::uint64_t MeshTextures::allBytes(const mesh::EymFile& file, TextureFormat format) {
    return bytesWithout(0, file.images(), format);
}

absl::StatusOr<MeshTextures> MeshTextures::read(const mesh::EymFile& file, std::uint64_t mostBytes,
                                                TextureFormat format) {
    MeshTextures read(file.images().size());
    const std::uint32_t drop = levelsToDrop(file.images(), mostBytes, format);
    if (drop > 0)
        spdlog::warn("{}: its textures are drawn without their {} finest levels: memory is short",
                     file.path(), drop);
    for (std::uint32_t i = 0; i < read.textures_.size(); ++i) {
        const mesh::ImageShape& shape = file.images()[i].shape;
        const std::uint32_t first = std::min(drop, shape.levels() - 1);
        const auto blocks = file.imageBlocks(i);
        if (absl::IsUnavailable(blocks.status()))
            return blocks.status();
        if (!blocks.ok()) {
            const absl::string_view message = blocks.status().message();
            spdlog::warn("{}; its mean colour stands for it until the scene is opened again",
                         std::string_view(message.data(), message.size()));
            uploadMean(read.textures_[i], shape);
            read.damaged_.push_back(static_cast<std::int32_t>(i));
            read.bytes_ += sizeof(fabric::Rgba);
        } else {
            (format == TextureFormat::Bc1 ? uploadBlocks : uploadTexels)(read.textures_[i], shape,
                                                                         *blocks, first);
            read.bytes_ += deviceBytes(shape, first, format);
        }
        setFilter(read.textures_[i], shape);
    }
    return read;
}

}  // namespace eyrie::draw
