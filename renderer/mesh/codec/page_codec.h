// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <absl/status/status.h>

#include "renderer/mesh/node_block.h"

/// Lossless coding of a node's geometry.
///
/// Triangles: one meets the edge, open since a recent triangle, that it goes along; told by the
/// edge's age. Its third corner is new, or the far end of an open edge next to that one, or,
/// seldom, elsewhere. After S. Gumhold, W. Strasser, "Real Time Compression of Triangle Mesh
/// Connectivity", 1998, but for triangles in the order they come in.
///
/// Vertices, in the order of first use: what is left of a position after the parallelogram with the
/// triangle across the edge (C. Touma, C. Gotsman, "Triangle Mesh Compression", 1998), of a normal
/// after the one that the node's own triangles give (normal_forecast.h), of a colour after the mean
/// of the edge's ends, and of texture coordinates after the same parallelogram. Without triangles
/// each vertex is foreseen to be like the one before it. Each number is an entropy-coded size and
/// plain bits (page_model.h).
///
/// A page, little-endian: uint32 bytes of the bits, even; uint32 words of the triangles' symbols;
/// the bits (shares of all contexts, then plain bits in order of use); the triangles' symbols, then
/// the vertices', as 16-bit words (codec/rans.h).
namespace eyrie::mesh {

/// Precondition: there are vertices; they come in the order in which the indices first use them,
/// all used, unless there are no indices; indices come in threes.
std::vector<std::byte> encodePage(const NodeGeometry& geometry);

/// Fills `arrays`, which has the node's shape. Safe on any bytes: DataLoss where these are no page
/// of that shape.
absl::Status decodePage(std::span<const std::byte> page, const NodeArrays& arrays);

/// No page that encodePage makes of a node of that shape is longer. A number is a symbol, of a word
/// at most, and at most 4 bytes of plain bits; a vertex has up to 11 of them, a triangle up to 3
/// and the symbol of the edge that it meets. The rest is sizes, states, and shares of 17 contexts
/// of up to 256 symbols, each in 3 bytes.
constexpr std::uint64_t mostPageBytes(const NodeShape& shape) {
    constexpr std::uint64_t kNumberBytes = 2 + 4;
    constexpr std::uint64_t kSharesAndSizes = 16 << 10;
    return kSharesAndSizes + std::uint64_t{shape.vertexCount} * 11 * kNumberBytes +
           std::uint64_t{shape.indexCount} / 3 * (2 + 3 * kNumberBytes);
}

}  // namespace eyrie::mesh
