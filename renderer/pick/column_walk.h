// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/pick/surface.h"

namespace eyrie::pick {

/// The part of a ray over one triangle of a height field. How high the ray is above the triangle
/// is above0 + rise * t; where it comes and goes, `comes` and `goes`, which are computed from the
/// triangle's sides alone: triangles that share a side agree to the bit, so no ray slips between.
struct Column {
    Span span;
    double comes = 0;
    double goes = 0;
    double above0 = 0;
    double rise = 0;
    double error = 0;  ///< vertical; positive

    /// Where the ray is that high above the triangle.
    double whereAbove(double height) const;
};

/// Follows a ray over a height field, column by column, and finds where it meets the drawn surface
/// and between where it meets the source, which is no more than each column's error above or below
/// the drawn one. docs/errors.md#picking.
class ColumnWalk {
public:
    /// Columns come in the order of their spans' beginnings. True when the column is where the
    /// drawn surface is first met.
    bool pass(const Column& column);

    double hit() const { return hit_; }
    double nearest() const { return nearest_; }
    /// The source has been met by then; infinite before that.
    double farthest() const { return farthest_; }

private:
    void passSource(double above, double t, const Column& column);

    double hit_ = kNowhere;
    double nearest_ = kNowhere;
    double farthest_ = kNowhere;
    double end_ = -kNowhere;  ///< of the columns so far
    // Since the last gap between columns the ray was, for certain:
    bool wasAbove_ = false;
    bool wasBelow_ = false;
};

}  // namespace eyrie::pick
