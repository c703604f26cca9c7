// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_tiles.h"

#include <algorithm>

namespace eyrie::draw {
namespace {

void uploadNormals(const gl::Texture2D& texture, std::span<const std::int8_t> normals,
                   GLsizei side) {
    glTextureStorage2D(texture.id(), 1, GL_RG8_SNORM, side, side);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.id(), 0, 0, 0, side, side, GL_RG, GL_BYTE, normals.data());
    glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

std::uint64_t normalBytes(std::uint64_t cells) { return 2 * (cells + 1) * (cells + 1); }

}  // namespace

DeviceTile::DeviceTile(const terrain::TileGeometry& geometry)
    : indexOffset(static_cast<GLintptr>(geometry.words.size_bytes())),
      vertexStride(4 * geometry.wordsPerVertex),
      parts(geometry.parts),
      baseHeight(geometry.baseHeight),
      heightMultiplier(geometry.heightMultiplier) {
    const auto words = static_cast<GLsizeiptr>(geometry.words.size_bytes());
    const auto indices = static_cast<GLsizeiptr>(geometry.indices.size_bytes());
    glNamedBufferStorage(buffer.id(), words + indices, nullptr, GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferSubData(buffer.id(), 0, words, geometry.words.data());
    glNamedBufferSubData(buffer.id(), words, indices, geometry.indices.data());
    uploadNormals(normalMap, geometry.normals, geometry.cells + 1);
}

std::uint64_t deviceBytes(const terrain::TileGeometry& geometry) {
    return geometry.words.size_bytes() + geometry.indices.size_bytes() +
           geometry.normals.size_bytes();
}

/// Euler's formula gives about half as many vertices as triangles and half the border's; the
/// fanned forms of the borders add about one triangle for each cell of the border.
std::uint64_t estimatedTileBytes(std::uint32_t triangles, std::int32_t cells) {
    if (triangles == 0)
        return 0;
    const auto side = static_cast<std::uint64_t>(cells);
    const std::uint64_t vertices = triangles / 2 + std::min<std::uint64_t>(triangles, 4 * side);
    const std::uint64_t drawn = triangles + std::min<std::uint64_t>(triangles, 8 * side);
    return 4 * vertices + 6 * drawn + normalBytes(side);
}

/// All posts of the tile and the midpoints of its border, two words each; each triangle in the
/// interior or in both forms of a border, and one more for each of the midpoints.
std::uint64_t greatestTileBytes(std::uint32_t triangles, std::int32_t cells) {
    if (triangles == 0)
        return 0;
    const auto side = static_cast<std::uint64_t>(cells);
    const std::uint64_t vertices =
        std::min((side + 1) * (side + 1), std::uint64_t{3} * triangles) + 8 * side;
    return 8 * vertices + 6 * (std::uint64_t{2} * triangles + 8 * side) + normalBytes(side);
}

}  // namespace eyrie::draw
