// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace eyrie::mesh {

/// How much a node's geometry is of.
struct NodeShape {
    std::uint32_t vertexCount = 0;
    std::uint32_t indexCount = 0;
    bool hasColours = false;
    bool hasTextures = false;

    bool operator==(const NodeShape&) const = default;
};

/// A node's geometry as it is read, decoded and sent to the device: one block of bytes with one
/// array after the other, padded with zeros to a multiple of 8.
///   uint64 [vertexCount]  positions (vertex_packing.h)
///   uint32 [vertexCount]  normals
///   uint32 [vertexCount]  colours, only where the mesh has them
///   int32 [2][vertexCount]  texture coordinates (material.h), only where it has them
///   uint16 [indexCount]   triangles
constexpr std::size_t blockBytes(const NodeShape& shape) {
    const std::size_t vertexBytes =
        12U + (shape.hasColours ? 4U : 0U) + (shape.hasTextures ? 8U : 0U);
    const std::size_t bytes = shape.vertexCount * vertexBytes + shape.indexCount * 2;
    return (bytes + 7) / 8 * 8;
}

/// The arrays of a block to be filled.
struct NodeArrays {
    NodeArrays(const NodeShape& shape, std::span<std::uint64_t> block) {
        auto* at = reinterpret_cast<std::byte*>(block.data());
        const auto take = [&]<typename T>(std::span<T>& array, std::size_t count) {
            array = {reinterpret_cast<T*>(at), count};
            at += array.size_bytes();
        };
        take(positions, shape.vertexCount);
        take(normals, shape.vertexCount);
        take(colours, shape.hasColours ? shape.vertexCount : 0);
        take(textureCoordinates, shape.hasTextures ? shape.vertexCount : 0);
        take(indices, shape.indexCount);
    }

    std::span<std::uint64_t> positions;
    std::span<std::uint32_t> normals;
    std::span<std::uint32_t> colours;
    std::span<glm::ivec2> textureCoordinates;
    std::span<std::uint16_t> indices;
};

/// A node's arrays, to be read. Whoever copies it shares what it lies in.
struct NodeGeometry {
    std::span<const std::uint64_t> positions;
    std::span<const std::uint32_t> normals;
    std::span<const std::uint32_t> colours;          ///< empty in a mesh without colours
    std::span<const glm::ivec2> textureCoordinates;  ///< the same
    std::span<const std::uint16_t> indices;          ///< each below positions.size()
    std::span<const std::byte> block;   ///< all of them, as above; empty where they lie apart
    std::shared_ptr<const void> owner;  ///< of the block
};

/// The arrays that lie in a block. Preconditions: it is aligned to 8 bytes and has
/// blockBytes(shape).
inline NodeGeometry geometryIn(std::span<const std::byte> block, const NodeShape& shape,
                               std::shared_ptr<const void> owner) {
    const std::byte* at = block.data();
    const auto take = [&]<typename T>(std::span<const T>& array, std::size_t count) {
        array = {reinterpret_cast<const T*>(at), count};
        at += array.size_bytes();
    };
    NodeGeometry geometry;
    take(geometry.positions, shape.vertexCount);
    take(geometry.normals, shape.vertexCount);
    take(geometry.colours, shape.hasColours ? shape.vertexCount : 0);
    take(geometry.textureCoordinates, shape.hasTextures ? shape.vertexCount : 0);
    take(geometry.indices, shape.indexCount);
    geometry.block = block;
    geometry.owner = std::move(owner);
    return geometry;
}

}  // namespace eyrie::mesh
