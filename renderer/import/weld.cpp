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

constexpr std::uint8_t kFree = 0;

/// Bits that say nothing about the place; not kFree.
std::uint8_t tagOf(std::uint64_t hash) { return static_cast<std::uint8_t>(hash >> 56 | 1); }

}  // namespace

Weld weld(std::span<const VertexKey> keys,
          std::span<const std::array<std::uint32_t, 3>> triangles) {
    Weld result;
    result.vertexOf.assign(keys.size(), kNoVertex);
    std::vector<std::uint32_t> table(std::bit_ceil(keys.size() * 2 + 1));
    // Of the hash, where the table holds a vertex: other vertices' keys, each of them far away in
    // memory, are hardly ever looked at.
    std::vector<std::uint8_t> tags(table.size(), kFree);
    const std::uint64_t mask = table.size() - 1;
    const auto find = [&](std::uint32_t key) {
        const std::uint64_t hashed = hash(keys[key]);
        const std::uint8_t tag = tagOf(hashed);
        std::uint64_t at = hashed & mask;
        while (tags[at] != kFree &&
               (tags[at] != tag || keys[result.firstKey[table[at]]] != keys[key]))
            at = (at + 1) & mask;
        if (tags[at] == kFree) {
            tags[at] = tag;
            table[at] = static_cast<std::uint32_t>(result.firstKey.size());
            result.firstKey.push_back(key);
        }
        return table[at];
    };
    const auto fetch = [&](std::uint32_t key) {
        const std::uint64_t at = hash(keys[key]) & mask;
        __builtin_prefetch(&tags[at], 1);
        __builtin_prefetch(&table[at], 1);
    };
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (i + kLookAhead < triangles.size())
            for (const std::uint32_t key : triangles[i + kLookAhead])
                if (result.vertexOf[key] == kNoVertex)
                    fetch(key);
        for (const std::uint32_t key : triangles[i])
            if (result.vertexOf[key] == kNoVertex)
                result.vertexOf[key] = find(key);
    }
    return result;
}

}  // namespace eyrie::import
