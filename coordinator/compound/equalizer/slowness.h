// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace eyrie::equalizer {

/// How slow each child of a compound is beside the others: what it takes for the same load.
///
/// The time of a part tells neither where load lies nor how slow the child is that drew it. A
/// LoadMap puts all of it down to the place. Where that is wrong its cuts move load from a slow
/// child to a quick one and find less of it there, again and again; so a little of what a time is
/// off is put down to the child, which adds up where it is always the same one's, and forgotten
/// slowly, so that a load that goes round makes nobody slow (docs/decisions/0099).
class Slowness {
public:
    explicit Slowness(std::size_t children) : logarithms_(children, 0.0) {}

    /// Above 0; the children's geometric mean is near 1.
    double operator[](std::size_t child) const;

    struct Measured {
        std::size_t child = 0;
        double time = 0;      ///< above 0
        double foreseen = 0;  ///< load; of a part of which nothing was known: 0
    };
    /// Of all parts of a frame that drew.
    void learn(std::span<const Measured> parts);

private:
    std::vector<double> logarithms_;
};

}  // namespace eyrie::equalizer
