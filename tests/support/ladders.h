// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "renderer/import/triangle_mesh.h"

namespace eyrie::test {

/// How high the ground of `ladders` is, metres.
inline double ladderHeight(double x, double y) { return 6 * std::sin(x / 9) * std::cos(y / 7); }

/// Hilly ground a hundred metres wide of `rows` strips of `length` squares, each a little over the
/// edge of the next. They are border all over, so that no level of detail has fewer triangles.
inline import::TriangleMesh ladders(std::uint32_t rows, std::uint32_t length) {
    import::TriangleMesh mesh;
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t i = 0; i <= length; ++i)
            for (const double side : {0.0, 1.0005}) {
                const double x = 100.0 * i / length;
                const double y = 100.0 * (row + side) / rows;
                mesh.positions.emplace_back(x, y, ladderHeight(x, y));
                const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
                if (i > 0 && side > 0) {
                    mesh.triangles.push_back({last - 3, last - 1, last});
                    mesh.triangles.push_back({last - 3, last, last - 2});
                }
            }
    return mesh;
}

}  // namespace eyrie::test
