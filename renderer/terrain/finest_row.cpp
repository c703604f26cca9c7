// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/finest_row.h"

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
                                 std::span<const float> thresholds, std::uint8_t* out) {
    const float* first = alongRow ? here - 1 : below;
    const float* second = alongRow ? here + 1 : above;
    const float* limits = thresholds.data();
    const auto count = static_cast<std::int32_t>(thresholds.size());
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
        out[i] = static_cast<std::uint8_t>(all == all ? exceeded : kFinestRowNodata);
    }
}

}  // namespace eyrie::terrain
