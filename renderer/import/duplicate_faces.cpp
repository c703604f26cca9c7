// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/duplicate_faces.h"

#include <algorithm>
#include <utility>

namespace eyrie::import {
namespace {

/// Turned so that its least point is the first.
mesh::Triangle fromLeast(const mesh::Triangle& corners) {
    const auto [a, b, c] = corners;
    if (a < b && a < c)
        return corners;
    return b < c ? mesh::Triangle{b, c, a} : mesh::Triangle{c, a, b};
}

}  // namespace

std::vector<bool> findDuplicates(std::span<const mesh::Triangle> triangles, std::size_t points) {
    // By their least points, in order: one pass, where sorting all of them took three times as
    // long.
    std::vector<std::uint32_t> end(points + 1, 0);
    for (const mesh::Triangle& triangle : triangles)
        ++end[std::min({triangle[0], triangle[1], triangle[2]}) + 1];
    for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
    std::vector<std::uint32_t> order(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        order[end[std::min({triangles[i][0], triangles[i][1], triangles[i][2]})]++] = i;

    std::vector<bool> isDuplicate(triangles.size(), false);
    std::size_t begin = 0;
    for (std::size_t point = 0; point < points; begin = end[point++]) {
        const std::span group(order.data() + begin, end[point] - begin);
        if (group.size() < 2)
            continue;
        std::sort(group.begin(), group.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(fromLeast(triangles[a]), a) < std::pair(fromLeast(triangles[b]), b);
        });
        for (std::size_t i = 1; i < group.size(); ++i)
            isDuplicate[group[i]] =
                fromLeast(triangles[group[i]]) == fromLeast(triangles[group[i - 1]]);
    }
    return isDuplicate;
}

}  // namespace eyrie::import
