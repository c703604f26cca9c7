// SPDX-License-Identifier: Apache-2.0
#include "fabric/depth_merge.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "fabric/simd_clones.h"

namespace eyrie::fabric {
namespace {

/// Pixels that are looked at together: where the source has none, or none that is nearer, nothing
/// is written, nor is more read. Memory is the limit, and layers of a scene mostly differ in whole
/// stretches.
constexpr int kStretch = 64;

/// All ones where the source stays, else 0. Non-negative floats order as their bits do, so the
/// comparison is one of integers: exact, total and, unlike that of floats, vectorised.
template <Ties ties>
std::uint32_t stays(std::uint32_t source, std::uint32_t target) {
    const auto theirs = static_cast<std::int32_t>(source);
    const auto ours = static_cast<std::int32_t>(target);
    return (ties == Ties::Source ? theirs >= ours : theirs > ours) ? ~0U : 0U;
}

inline __attribute__((always_inline)) bool isUndrawn(const std::uint32_t* depth, int count) {
    std::uint32_t any = 0;
    for (int i = 0; i < count; ++i) any |= depth[i];
    return any == 0;
}

struct Row {
    const std::uint32_t* sourceDepth;
    const std::uint32_t* sourceColour;
    std::uint32_t* depth;
    std::uint32_t* colour;
    int count;
};

template <Ties ties>
inline __attribute__((always_inline)) void mergeStretches(Row row) {
    const std::uint32_t* __restrict const sourceDepth = row.sourceDepth;
    const std::uint32_t* __restrict const sourceColour = row.sourceColour;
    std::uint32_t* __restrict const depth = row.depth;
    std::uint32_t* __restrict const colour = row.colour;
    for (int begin = 0; begin < row.count; begin += kStretch) {
        const int end = std::min(begin + kStretch, row.count);
        if (ties == Ties::Target && isUndrawn(sourceDepth + begin, end - begin))
            continue;
        std::uint32_t any = 0;
        for (int i = begin; i < end; ++i) any |= stays<ties>(sourceDepth[i], depth[i]);
        if (any == 0)
            continue;
        for (int i = begin; i < end; ++i) {
            const std::uint32_t mask = stays<ties>(sourceDepth[i], depth[i]);
            depth[i] = (sourceDepth[i] & mask) | (depth[i] & ~mask);
            colour[i] = (sourceColour[i] & mask) | (colour[i] & ~mask);
        }
    }
}

EYRIE_SIMD_CLONES void mergeRow(Row row) { mergeStretches<Ties::Target>(row); }
EYRIE_SIMD_CLONES void mergeRowBefore(Row row) { mergeStretches<Ties::Source>(row); }

template <typename T>
auto bits(T* values) {
    using Word = std::conditional_t<std::is_const_v<T>, const std::uint32_t, std::uint32_t>;
    return reinterpret_cast<Word*>(values);
}

}  // namespace

void mergeDepth(const ImageView& source, Image& target, Ties ties) {
    assert(source.hasDepth() && target.hasDepth());
    assert(target.area.contains(source.area));
    const auto merge = ties == Ties::Source ? mergeRowBefore : mergeRow;
    const auto sourceWidth = static_cast<std::size_t>(source.area.width);
    const auto targetWidth = static_cast<std::size_t>(target.area.width);
    for (int y = 0; y < source.area.height; ++y) {
        const auto from = static_cast<std::size_t>(y) * sourceWidth;
        const auto to = static_cast<std::size_t>(source.area.y + y - target.area.y) * targetWidth +
                        static_cast<std::size_t>(source.area.x - target.area.x);
        merge({bits(source.depth.data() + from), bits(source.colour.data() + from),
               bits(target.depth.data() + to), bits(target.colour.data() + to), source.area.width});
    }
}

}  // namespace eyrie::fabric
