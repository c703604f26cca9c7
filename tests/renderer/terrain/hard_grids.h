// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/terrain/height_grid.h"

namespace eyrie::test {

/// Elevation models that are small and nasty.
enum class GridKind {
    Noise,         ///< every post on its own, fractions of a metre
    Smooth,        ///< hills
    Plane,         ///< a slope that no binary fraction holds
    Flat,          ///< the sea
    Spikes,        ///< flat but for single posts
    Cliff,         ///< a step of 4000 m
    Comb,          ///< columns of 0 and 4000 m in turn
    Checkerboard,  ///< +-20 m: what the midpoint of a hypotenuse never sees
    Terraces,      ///< whole metres, flat steps
};
inline constexpr int kGridKinds = 9;

std::string name(GridKind kind);

/// Posts 10 m apart, south-west post at (500000, 5200000).
terrain::HeightGrid hardGrid(GridKind kind, std::int32_t columns, std::int32_t rows,
                             std::uint64_t seed);

/// A small deterministic random number generator (splitmix64).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next();
    /// From low to high, both included.
    std::int32_t integer(std::int32_t low, std::int32_t high);
    double unit();  ///< [0, 1)

private:
    std::uint64_t state_;
};

}  // namespace eyrie::test
