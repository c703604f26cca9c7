// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace eyrie::import {

/// What makes two vertices the same. Packed as they are stored (mesh/vertex_packing.h).
struct VertexKey {
    std::uint64_t position = 0;
    std::uint32_t normal = 0;
    std::uint32_t colour = 0;
    std::uint32_t exact = 0;    ///< number of its source position; 0 where that does not matter
    std::uint32_t texture = 0;  ///< number of its material and texture coordinates; the same

    bool operator==(const VertexKey&) const = default;
};

inline constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

struct Weld {
    std::vector<std::uint32_t> vertexOf;  ///< per key its vertex; kNoVertex where no corner uses it
    std::vector<std::uint32_t> firstKey;  ///< per vertex, the first key that a corner used

    std::size_t vertexCount() const { return firstKey.size(); }
};

/// Makes one vertex of all equal keys that `triangles` use, numbered in the order of first use.
/// Preconditions: fewer than 2^32 - 1 keys; every corner is below keys.size().
Weld weld(std::span<const VertexKey> keys, std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace eyrie::import
