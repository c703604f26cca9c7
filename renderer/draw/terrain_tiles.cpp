// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_tiles.h"

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

}  // namespace

DeviceTile::DeviceTile(const terrain::TileGeometry& geometry)
    : indexOffset(static_cast<GLintptr>(geometry.words.size_bytes())),
      vertexStride(4 * geometry.wordsPerVertex),
      parts(geometry.parts),
      baseHeight(geometry.baseHeight),
      heightMultiplier(geometry.heightMultiplier) {
    const auto words = static_cast<GLsizeiptr>(geometry.words.size_bytes());
    const auto indices = static_cast<GLsizeiptr>(geometry.indices.size_bytes());
    if (!geometry.isEmpty()) {
        glNamedBufferStorage(buffer.id(), words + indices, nullptr, GL_DYNAMIC_STORAGE_BIT);
        glNamedBufferSubData(buffer.id(), 0, words, geometry.words.data());
        glNamedBufferSubData(buffer.id(), words, indices, geometry.indices.data());
    }
    if (!geometry.normals.empty())
        uploadNormals(normalMap.emplace(), geometry.normals, geometry.cells + 1);
}

}  // namespace eyrie::draw
