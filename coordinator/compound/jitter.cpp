// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/jitter.h"

#include <array>
#include <span>

namespace eyrie::compound {
namespace {

// The row of the sample in each column.
constexpr std::array<int, 2> kRows2 = {1, 0};
constexpr std::array<int, 3> kRows3 = {1, 2, 0};
constexpr std::array<int, 4> kRows4 = {1, 3, 0, 2};
constexpr std::array<int, 8> kRows8 = {3, 6, 2, 7, 1, 4, 0, 5};
constexpr std::array<int, 16> kRows16 = {3, 11, 7, 15, 1, 9, 13, 5, 12, 8, 2, 14, 4, 0, 10, 6};

std::span<const int> rows(std::int64_t count) {
    switch (count) {
        case 2:
            return kRows2;
        case 3:
            return kRows3;
        case 4:
            return kRows4;
        case 8:
            return kRows8;
        case 16:
            return kRows16;
        default:
            return {};
    }
}

/// The lowest 32 bits of `index`, in reverse.
std::uint32_t reversedBits(std::int64_t index) {
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit, index /= 2)
        reversed = reversed * 2 + static_cast<std::uint32_t>(index % 2);
    return reversed;
}

/// Its place among all, by their reversed bits.
int reversedRow(std::int64_t index, std::int64_t count) {
    int before = 0;
    for (std::int64_t other = 0; other < count; ++other)
        before += reversedBits(other) < reversedBits(index) ? 1 : 0;
    return before;
}

}  // namespace

fabric::Vec2 jitter(std::int64_t index, std::int64_t count) {
    if (count <= 1)
        return {0, 0};
    const auto pattern = rows(count);
    const int row =
        pattern.empty() ? reversedRow(index, count) : pattern[static_cast<std::size_t>(index)];
    const auto places = static_cast<double>(count);
    return {(static_cast<double>(index) + .5) / places - .5, (row + .5) / places - .5};
}

}  // namespace eyrie::compound
