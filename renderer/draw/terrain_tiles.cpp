// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_tiles.h"

#include <algorithm>
#include <utility>

#include "renderer/terrain/vertex_packing.h"

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

/// In object space.
fabric::Vec3 position(const terrain::EytIndex& index, const terrain::TileId& id,
                      const terrain::TileVertex& vertex) {
    using terrain::Quadtree;
    const auto post = [&](std::int32_t number, std::int32_t halves, std::int32_t posts) {
        return std::min(
            number * Quadtree::side(id.level) + (halves << Quadtree::spacingShift(id.level)) / 2,
            posts - 1);
    };
    return fabric::Vec3(index.objectFromLattice *
                        fabric::Vec4(post(id.x, vertex.x, index.quadtree.columns()),
                                     post(id.y, vertex.y, index.quadtree.rows()), vertex.q, 1));
}

/// Of the parts in which a triangle lies, in fifteenths of the tile's error.
std::size_t partError(const terrain::EytIndex& index, const terrain::TileId& id,
                      const std::array<terrain::TileVertex, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const std::int32_t side = 2 * terrain::Quadtree::cells(id.level) / terrain::kTilePartsPerSide;
    const auto extent = [&](std::int32_t p, std::int32_t q, std::int32_t r) {
        return std::pair(std::min({p, q, r}) / side, (std::max({p, q, r}) - 1) / side);
    };
    const auto [x0, x1] = extent(a.x, b.x, c.x);
    const auto [y0, y1] = extent(a.y, b.y, c.y);
    int greatest = 0;
    for (std::int32_t y = y0; y <= y1; ++y)
        for (std::int32_t x = x0; x <= x1; ++x)
            greatest = std::max(greatest, index.tile(id).partError(x, y));
    return static_cast<std::size_t>(greatest);
}

}  // namespace

DeviceTile::DeviceTile(const terrain::TileGeometry& geometry, TileDecoder* decoder)
    : indexOffset(static_cast<GLintptr>(geometry.wordBytes())),
      vertexStride(4 * geometry.wordsPerVertex),
      parts(geometry.parts),
      blocks(terrain::triangleBlocks(geometry)),
      baseHeight(geometry.baseHeight),
      heightMultiplier(geometry.heightMultiplier) {
    const auto words = static_cast<GLsizeiptr>(geometry.wordBytes());
    const auto indices = static_cast<GLsizeiptr>(geometry.indexBytes());
    const GLsizeiptr bytes = words + (indices + 3) / 4 * 4;
    if (!geometry.isEmpty())
        glNamedBufferStorage(buffer.id(), bytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
    if (!geometry.outline.empty()) {
        decoder->decode(geometry.outline, buffer, static_cast<std::size_t>(bytes));
    } else if (!geometry.isEmpty()) {
        glNamedBufferSubData(buffer.id(), 0, words, geometry.words.data());
        glNamedBufferSubData(buffer.id(), words, indices, geometry.indices.data());
    }
    if (!geometry.normals.empty())
        uploadNormals(normalMap.emplace(), geometry.normals, geometry.cells + 1);
}

std::array<int, 1 + terrain::kEdges> drawnParts(const terrain::TileChoice& choice) {
    std::array<int, 1 + terrain::kEdges> parts{terrain::kInteriorPart};
    for (int edge = 0; edge < terrain::kEdges; ++edge) {
        const bool isFiner = (choice.finerEdges >> edge & 1) != 0;
        parts[static_cast<std::size_t>(1 + edge)] =
            (isFiner ? terrain::kFinerPart : terrain::kOwnPart) + edge;
    }
    return parts;
}

CornersByError drawnCorners(const terrain::EytIndex& index, const terrain::TileChoice& choice,
                            const DeviceTile& tile) {
    const terrain::IndexRange& last = tile.parts.back();
    std::vector<std::uint32_t> words(static_cast<std::size_t>(tile.indexOffset) / 4);
    std::vector<std::uint16_t> indices(last.first + last.count);
    glGetNamedBufferSubData(tile.buffer.id(), 0, tile.indexOffset, words.data());
    glGetNamedBufferSubData(tile.buffer.id(), tile.indexOffset,
                            static_cast<GLsizeiptr>(indices.size() * sizeof indices[0]),
                            indices.data());
    const auto vertex = [&](std::uint16_t number) {
        return terrain::unpackVertex(words, tile.vertexStride / 4, number, tile.baseHeight,
                                     tile.heightMultiplier);
    };
    CornersByError corners;
    for (const int part : drawnParts(choice)) {
        const terrain::IndexRange& range = tile.parts[static_cast<std::size_t>(part)];
        for (std::uint32_t k = range.first; k < range.first + range.count; k += 3) {
            const std::array<terrain::TileVertex, 3> triangle = {
                vertex(indices[k]), vertex(indices[k + 1]), vertex(indices[k + 2])};
            std::vector<fabric::Vec3>& list = corners[partError(index, choice.id, triangle)];
            for (const terrain::TileVertex& corner : triangle)
                list.push_back(position(index, choice.id, corner));
        }
    }
    return corners;
}

}  // namespace eyrie::draw
