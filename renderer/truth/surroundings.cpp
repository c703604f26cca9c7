// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/surroundings.h"

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>

namespace eyrie::truth {
namespace {

/// Replaces `count` values, `step` apart, each by the sum of those up to `reach` away.
void widen(Surroundings* values, std::size_t count, std::size_t step, std::size_t reach) {
    const std::size_t block = 2 * reach + 1;
    // Sums from each block's first value, and to its last.
    std::vector<Surroundings> from(count), to(count);
    for (std::size_t i = 0; i < count; ++i) {
        from[i] = values[i * step];
        if (i % block != 0)
            from[i].add(from[i - 1]);
    }
    for (std::size_t i = count; i-- > 0;) {
        to[i] = values[i * step];
        if (i + 1 < count && (i + 1) % block != 0)
            to[i].add(to[i + 1]);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i - std::min(i, reach);
        const std::size_t last = std::min(i + reach, count - 1);
        // Within one block a window begins or ends where that does, or where the values do.
        Surroundings& sum = values[i * step];
        sum = first % block == 0 ? from[last] : to[first];
        if (first / block != last / block)
            sum.add(from[last]);
    }
}

}  // namespace

void Surroundings::add(const ReferenceSurface::HitRange& hit) {
    anyHit = anyHit || hit.first != kNoHit;
    anyMiss = anyMiss || hit.last == kNoHit;
    nearest = std::min(nearest, hit.first);
    farthest = std::max(farthest, hit.last);
}

void Surroundings::add(const Surroundings& other) {
    anyHit = anyHit || other.anyHit;
    anyMiss = anyMiss || other.anyMiss;
    nearest = std::min(nearest, other.nearest);
    farthest = std::max(farthest, other.farthest);
}

std::vector<Surroundings> surroundings(std::span<const ReferenceSurface::HitRange> hits, int width,
                                       int reach) {
    std::vector<Surroundings> around(hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i) around[i].add(hits[i]);
    const auto columns = static_cast<std::size_t>(width);
    const std::size_t rows = hits.size() / columns;
    const auto pixels = static_cast<std::size_t>(reach);
    tbb::parallel_for(std::size_t{0}, rows,
                      [&](std::size_t y) { widen(&around[y * columns], columns, 1, pixels); });
    tbb::parallel_for(std::size_t{0}, columns,
                      [&](std::size_t x) { widen(&around[x], rows, columns, pixels); });
    return around;
}

}  // namespace eyrie::truth
