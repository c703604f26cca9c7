// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/shrink.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace eyrie::stream {
namespace {

using fabric::Rgba;

/// Some neighbours in a row or column, with weights that add up to kOne.
struct Cover {
    std::size_t first = 0;
    std::vector<std::uint32_t> weights;
};
constexpr std::uint32_t kOne = 1u << 12;

/// What each of `to` equal parts covers of `from` pixels.
std::vector<Cover> covers(int from, int to) {
    std::vector<Cover> found(static_cast<std::size_t>(to));
    const std::int64_t wide = from;  // a part, where a pixel is `to` wide
    for (int i = 0; i < to; ++i) {
        const std::int64_t begin = i * wide;
        const std::int64_t end = begin + wide;
        Cover& cover = found[static_cast<std::size_t>(i)];
        cover.first = static_cast<std::size_t>(begin / to);
        std::uint32_t given = 0;
        for (std::int64_t at = begin; at < end;) {
            const std::int64_t next = std::min(end, (at / to + 1) * to);
            // Of the whole up to here, so that the weights add up.
            const auto upTo = static_cast<std::uint32_t>((next - begin) * kOne / wide);
            cover.weights.push_back(upTo - given);
            given = upTo;
            at = next;
        }
    }
    return found;
}

using Sum = std::array<std::uint32_t, 3>;

/// One row of `from` pixels to sums of kOne × 255.
void acrossRow(const Rgba* row, const std::vector<Cover>& columns, std::vector<Sum>& sums) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
        Sum sum{};
        const Rgba* pixel = row + columns[i].first;
        for (const std::uint32_t weight : columns[i].weights) {
            sum[0] += weight * pixel->r;
            sum[1] += weight * pixel->g;
            sum[2] += weight * pixel->b;
            ++pixel;
        }
        sums[i] = sum;
    }
}

}  // namespace

fabric::Image shrunk(const fabric::Image& image, int width, int height) {
    assert(width >= 1 && width <= image.area.width);
    assert(height >= 1 && height <= image.area.height);
    fabric::Image result = fabric::makeImage({0, 0, width, height}, {}, false);
    const std::vector<Cover> columns = covers(image.area.width, width);
    std::vector<Sum> row(columns.size());
    std::vector<std::array<std::uint64_t, 3>> sums(columns.size());
    Rgba* to = result.colour.data();
    const auto stride = static_cast<std::size_t>(image.area.width);
    for (const Cover& rows : covers(image.area.height, height)) {
        std::ranges::fill(sums, std::array<std::uint64_t, 3>{});
        for (std::size_t j = 0; j < rows.weights.size(); ++j) {
            acrossRow(image.colour.data() + (rows.first + j) * stride, columns, row);
            for (std::size_t i = 0; i < row.size(); ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    sums[i][c] += std::uint64_t{rows.weights[j]} * row[i][c];
        }
        constexpr std::uint64_t kHalf = std::uint64_t{kOne} * kOne / 2;
        const auto mean = [](std::uint64_t sum) {
            return static_cast<std::uint8_t>((sum + kHalf) / (std::uint64_t{kOne} * kOne));
        };
        for (const auto& [r, g, b] : sums) *to++ = {mean(r), mean(g), mean(b), 255};
    }
    return result;
}

}  // namespace eyrie::stream
