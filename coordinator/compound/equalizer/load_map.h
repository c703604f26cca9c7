// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "coordinator/compound/equalizer/area.h"

namespace eyrie::equalizer {

/// Where the load of a picture, or of a range of the data, lies, as far as the times of its parts
/// have told.
///
/// A part's time says how much lies in it, not where: at first it counts as spread evenly over the
/// region that was covered, as Equalizer takes it (Eilemann, Makhinya, Pajarola 2009). What parts
/// cut otherwise told before is kept in proportion, as in multiplicative algebraic reconstruction
/// (Gordon, Bender, Herman: "Algebraic Reconstruction Techniques", 1970), and forgotten
/// slowly, or faster the more of what it foretells is wrong. So
/// the cuts of several frames close in on a load that one frame's do not show, where an even spread
/// alone throws the cuts from one side of it to the other and back.
class LoadMap {
public:
    /// Of [0, 1] x [0, 1] in cells within which load is even: at first all of it.
    LoadMap(int columns, int rows);

    struct Measured {
        Area part;        ///< within [0, 1] x [0, 1]
        Area region;      ///< of the part that was covered: there lies its load
        double load = 0;  ///< finite, above 0
    };
    /// `parts` cover the whole once, but for what cost nothing.
    void record(std::span<const Measured> parts);

    double load(const Area& area) const;

    /// Where on `axis` `area` is to be cut so that `share` of its load lies before; where any place
    /// between two is right, the one nearest to `wanted`.
    double cut(const Area& area, Axis axis, double share, double wanted) const;

private:
    struct Overlap;
    Overlap overlap(const Area& area) const;
    void add(const Measured& part, double forgotten, std::vector<double>& densities) const;
    std::vector<double> profile(const Area& area, Axis axis) const;

    double density(int row, int column) const;

    int columns_;
    int rows_;
    std::vector<double> densities_;  ///< by rows; load over area; none: 1 everywhere
};

}  // namespace eyrie::equalizer
