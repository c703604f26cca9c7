// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "renderer/terrain/deviation.h"

/// Which cells of the raster a triangle with corners on posts lies in.
namespace eyrie::terrain {

/// The posts around a triangle, all included.
struct PostBounds {
    explicit PostBounds(const Triangle& t)
        : i0(std::min({t[0].i, t[1].i, t[2].i})),
          j0(std::min({t[0].j, t[1].j, t[2].j})),
          i1(std::max({t[0].i, t[1].i, t[2].i})),
          j1(std::max({t[0].j, t[1].j, t[2].j})) {}

    std::int32_t i0, j0, i1, j1;
};

/// Whether a triangle's inside or border may meet a block: not wholly beyond one of its sides.
class Overlap {
public:
    /// Keeps a reference.
    explicit Overlap(const Triangle& t) : t_(t) {
        const std::int64_t area = std::int64_t{t[1].i - t[0].i} * (t[2].j - t[0].j) -
                                  std::int64_t{t[2].i - t[0].i} * (t[1].j - t[0].j);
        sign_ = area < 0 ? -1 : 1;
    }
    bool meets(std::int32_t i0, std::int32_t j0, std::int32_t cells) const {
        for (std::size_t e = 0; e < 3; ++e) {
            const Corner& a = t_[e];
            const Corner& b = t_[(e + 1) % 3];
            const std::int64_t nx = -sign_ * std::int64_t{b.j - a.j};
            const std::int64_t ny = sign_ * std::int64_t{b.i - a.i};
            const std::int64_t inmost =
                nx * (i0 + (nx > 0 ? cells : 0) - a.i) + ny * (j0 + (ny > 0 ? cells : 0) - a.j);
            if (inmost < 0)
                return false;
        }
        return true;
    }
    bool has(std::int32_t i, std::int32_t j) const { return meets(i, j, 0); }

private:
    const Triangle& t_;
    std::int64_t sign_ = 1;
};

/// Whether its sides run along rows, columns and cells' diagonals, so that they leave no part of a
/// cell but a half.
inline bool crossesCellsAtPosts(const Triangle& t) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t di = std::abs(t[k].i - t[(k + 1) % 3].i);
        const std::int32_t dj = std::abs(t[k].j - t[(k + 1) % 3].j);
        if (di != 0 && dj != 0 && di != dj)
            return false;
    }
    return true;
}

}  // namespace eyrie::terrain
