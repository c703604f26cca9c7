// SPDX-License-Identifier: Apache-2.0
#include "fabric/depth_merge.h"

#include <bit>
#include <cassert>
#include <cstring>

#include "fabric/simd_clones.h"

namespace eyrie::fabric {
namespace {

/// Non-negative floats order as their bits do, so the comparison is one of integers: exact, total
/// and, unlike that of floats, vectorised into a compare and two blends.
EYRIE_SIMD_CLONES void mergeRow(const std::uint32_t* __restrict sourceDepth,
                                const std::uint32_t* __restrict sourceColour,
                                std::uint32_t* __restrict depth, std::uint32_t* __restrict colour,
                                int count) {
    for (int i = 0; i < count; ++i) {
        const auto theirs = static_cast<std::int32_t>(sourceDepth[i]);
        const auto ours = static_cast<std::int32_t>(depth[i]);
        const std::uint32_t mask = theirs > ours ? ~0U : 0U;
        depth[i] = (sourceDepth[i] & mask) | (depth[i] & ~mask);
        colour[i] = (sourceColour[i] & mask) | (colour[i] & ~mask);
    }
}

template <typename T>
auto bits(T* values) {
    using Word = std::conditional_t<std::is_const_v<T>, const std::uint32_t, std::uint32_t>;
    return reinterpret_cast<Word*>(values);
}

}  // namespace

void mergeDepth(const Image& source, Image& target) {
    assert(source.hasDepth() && target.hasDepth());
    assert(target.area.contains(source.area));
    for (int y = 0; y < source.area.height; ++y) {
        const auto from = static_cast<std::size_t>(y) * source.area.width;
        const auto to =
            static_cast<std::size_t>(source.area.y + y - target.area.y) * target.area.width +
            static_cast<std::size_t>(source.area.x - target.area.x);
        mergeRow(bits(source.depth.data() + from), bits(source.colour.data() + from),
                 bits(target.depth.data() + to), bits(target.colour.data() + to),
                 source.area.width);
    }
}

}  // namespace eyrie::fabric
