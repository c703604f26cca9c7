// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/duplicate_faces.h"

#include <algorithm>
#include <utility>

namespace eyrie::import {
namespace {

/// Triangles at a point above which they are sorted, not compared each with each; and in one place
/// how many may hide those after them.
constexpr std::size_t kFew = 8;

/// The corners after the least one, in their turn, in one word.
std::uint64_t turnFromLeast(const mesh::Triangle& corners) {
    const auto [a, b, c] = corners;
    const auto word = [](std::uint64_t first, std::uint64_t second) {
        return first << 32 | second;
    };
    if (a < b && a < c)
        return word(b, c);
    return b < c ? word(c, a) : word(a, b);
}

/// A triangle at the point that is its least.
struct Entry {
    std::uint64_t turn;
    std::uint32_t triangle;

    bool operator<(const Entry& other) const {
        return std::pair(turn, triangle) < std::pair(other.turn, other.triangle);
    }
};

/// Marks those of one point, given in their order.
void markDuplicates(std::span<Entry> entries, const Hides& hides, std::vector<bool>& isDuplicate) {
    const bool isSorted = entries.size() > kFew;
    if (isSorted)
        std::sort(entries.begin(), entries.end());
    std::size_t first = 0;  // to compare with
    for (std::size_t i = 1; i < entries.size(); ++i) {
        if (isSorted && entries[i].turn != entries[first].turn)
            first = i;
        for (std::size_t j = first; j < std::min(i, first + kFew); ++j)
            if (entries[i].turn == entries[j].turn &&
                hides(entries[j].triangle, entries[i].triangle)) {
                isDuplicate[entries[i].triangle] = true;
                break;
            }
    }
}

}  // namespace

std::vector<bool> findDuplicates(std::span<const mesh::Triangle> triangles, std::size_t points,
                                 const Hides& hides) {
    // By their least points: a few passes, where sorting all would take the logarithm of their
    // number.
    std::vector<std::uint32_t> end(points + 1, 0);
    for (const mesh::Triangle& triangle : triangles)
        ++end[std::min({triangle[0], triangle[1], triangle[2]}) + 1];
    for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
    std::vector<Entry> entries(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const mesh::Triangle& triangle = triangles[i];
        entries[end[std::min({triangle[0], triangle[1], triangle[2]})]++] = {
            turnFromLeast(triangle), i};
    }
    std::vector<bool> isDuplicate(triangles.size(), false);
    std::size_t begin = 0;
    for (std::size_t point = 0; point < points; begin = end[point++])
        markDuplicates(std::span(entries).subspan(begin, end[point] - begin), hides, isDuplicate);
    return isDuplicate;
}

}  // namespace eyrie::import
