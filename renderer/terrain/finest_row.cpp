// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/finest_row.h"

#include <algorithm>
#include <cmath>

#include "fabric/simd_clones.h"

namespace eyrie::terrain {
namespace {

inline float larger(float a, float b) { return a > b ? a : b; }

/// The drawn leg between two neighbours of a post against its cell's other diagonal, at the centre.
inline float atCentre(float neighbour, float otherNeighbour, float post, float cornerPost) {
    return std::abs((neighbour - post) + (otherNeighbour - cornerPost)) * 0.5F;
}

}  // namespace

EYRIE_SIMD_CLONES void finestRow(const float* below, const float* here, const float* above,
                                 std::int32_t columns, bool alongRow, float tolerance,
                                 const DeviationScale& scale, std::uint8_t* out) {
    const float* first = alongRow ? here - 1 : below;
    const float* second = alongRow ? here + 1 : above;
    const float* limits = scale.floatMetres().data();
    const float* last = scale.floatLast();
    const float* eighths = scale.floatEighths();
    const auto count = static_cast<std::int32_t>(scale.thresholds());
    for (std::int32_t i = 1; i < columns - 1; ++i) {
        const float h = here[i];
        const float atPost = std::abs((h - first[i]) + (h - second[i])) * 0.5F;
        const float low = larger(atCentre(here[i - 1], below[i], h, below[i - 1]),
                                 atCentre(here[i + 1], below[i], h, below[i + 1]));
        const float high = larger(atCentre(here[i - 1], above[i], h, above[i - 1]),
                                  atCentre(here[i + 1], above[i], h, above[i + 1]));
        const float worst = larger(atPost, larger(low, high));
        const float deviation = atPost > tolerance ? worst : atPost;
        std::int32_t exceeded = 0;
        for (std::int32_t k = 0; k < count; ++k) exceeded += deviation > limits[k] ? 1 : 0;
        const float all = (h + here[i - 1] + here[i + 1]) +
                          (below[i - 1] + below[i] + below[i + 1]) +
                          (above[i - 1] + above[i] + above[i + 1]);
        const float reach = (deviation - last[exceeded]) * eighths[exceeded];
        const auto eighth = static_cast<std::int32_t>(reach < 7.0F ? reach : 7.0F);
        out[i] = static_cast<std::uint8_t>(
            all == all ? exceeded << DeviationScale::kEighthBits | eighth : kFinestRowNodata);
    }
}

SourceSurface::Inside finestCentre(const float* centre, std::ptrdiff_t stride, bool isMain,
                                   double tolerance) {
    const auto at = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
        return static_cast<double>(centre[j * stride + i]);
    };
    const std::ptrdiff_t d = isMain ? 1 : -1;
    const double from = at(-d, -1), to = at(d, 1);
    const double west = at(-1, 0), east = at(1, 0), south = at(0, -1), north = at(0, 1);
    const double before = isMain ? west : east, after = isMain ? east : west;
    // Cells on either side of the centre along the hypotenuse: their other diagonals.
    const double slope = (to - from) / 2;
    const double atCentres = std::max(std::abs(from + slope * 0.5 - (south + before) / 2),
                                      std::abs(from + slope * 1.5 - (after + north) / 2));
    const double atMiddle = std::abs(at(0, 0) - (from + to) / 2);
    double deviation = 0;
    double greatest = atCentres;
    const auto addTriangle = [&](double apex, double besideFrom, double besideTo) {
        const double atPosts = std::max({atMiddle, std::abs(besideFrom - (from + apex) / 2),
                                         std::abs(besideTo - (to + apex) / 2)});
        greatest = std::max(greatest, atPosts);
        deviation =
            std::max(deviation, atPosts > tolerance ? std::max(atPosts, atCentres) : atPosts);
    };
    addTriangle(at(d, -1), south, after);
    addTriangle(at(-d, 1), before, north);
    return {deviation, greatest};
}

}  // namespace eyrie::terrain
