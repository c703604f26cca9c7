// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/weld.h"

#include <bit>
#include <cstddef>

namespace eyrie::import {
namespace {

/// Triangles ahead of the one in hand whose places in the table are fetched already.
constexpr std::size_t kLookAhead = 16;

/// Murmur3's finaliser: every bit of the key moves every bit of the place.
std::uint64_t mix(std::uint64_t value) {
    value = (value ^ value >> 33) * 0xFF51AFD7ED558CCDULL;
    value = (value ^ value >> 33) * 0xC4CEB9FE1A85EC53ULL;
    return value ^ value >> 33;
}

std::uint64_t hash(const VertexKey& key) {
    const std::uint64_t attributes = std::uint64_t{key.normal} << 32 | key.colour;
    return mix(key.position + mix(attributes + mix(std::uint64_t{key.texture} << 32 | key.exact)));
}

}  // namespace

Weld weld(std::span<const VertexKey> keys,
          std::span<const std::array<std::uint32_t, 3>> triangles) {
    Weld result;
    result.vertexOf.assign(keys.size(), kNoVertex);
    std::vector<std::uint32_t> table(std::bit_ceil(keys.size() * 2 + 1), kNoVertex);
    const std::uint64_t mask = table.size() - 1;
    const auto find = [&](std::uint32_t key) {
        std::uint64_t at = hash(keys[key]) & mask;
        while (table[at] != kNoVertex && keys[result.firstKey[table[at]]] != keys[key])
            at = (at + 1) & mask;
        if (table[at] == kNoVertex) {
            table[at] = static_cast<std::uint32_t>(result.firstKey.size());
            result.firstKey.push_back(key);
        }
        return table[at];
    };
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (i + kLookAhead < triangles.size())
            for (const std::uint32_t key : triangles[i + kLookAhead])
                if (result.vertexOf[key] == kNoVertex)
                    __builtin_prefetch(&table[hash(keys[key]) & mask], 1);
        for (const std::uint32_t key : triangles[i])
            if (result.vertexOf[key] == kNoVertex)
                result.vertexOf[key] = find(key);
    }
    return result;
}

}  // namespace eyrie::import
