// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/column_walk.h"

#include <algorithm>
#include <cmath>

namespace eyrie::pick {

double Column::whereAbove(double height) const {
    return rise == 0 ? span.begin : std::clamp((height - above0) / rise, span.begin, span.end);
}

bool ColumnWalk::pass(const Column& column) {
    if (column.span.begin > end_)
        wasAbove_ = wasBelow_ = false;
    end_ = std::max(end_, column.span.end);
    const auto [lowest, highest] = std::minmax(column.comes, column.goes);
    if (nearest_ == kNowhere && lowest <= column.error && highest >= -column.error)
        nearest_ = std::abs(column.comes) <= column.error
                       ? column.span.begin
                       : column.whereAbove(std::copysign(column.error, column.comes));
    const bool isHit = hit_ == kNowhere && (column.comes > 0) != (column.goes > 0);
    if (isHit)
        hit_ = column.whereAbove(0);
    passSource(column.comes, column.span.begin, column);
    passSource(column.goes, column.whereAbove(std::copysign(column.error, column.goes)), column);
    return isHit;
}

/// The ray is `above` the column: beyond the error, and by `t` if it was on the other side before.
void ColumnWalk::passSource(double above, double t, const Column& column) {
    if (std::abs(above) < column.error)
        return;
    if (above > 0 ? wasBelow_ : wasAbove_)
        farthest_ = std::min(farthest_, t);
    (above > 0 ? wasAbove_ : wasBelow_) = true;
}

}  // namespace eyrie::pick
