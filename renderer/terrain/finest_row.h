// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "renderer/terrain/deviation.h"
#include "renderer/terrain/deviation_scale.h"

namespace eyrie::terrain {

/// Result where a post among the nine is nodata.
inline constexpr std::uint8_t kFinestRowNodata = 0xff;

/// What SourceSurface says of half of all vertices, a row at a time: those that split triangles
/// with a hypotenuse of two posts. For each i from 1 to columns - 2, out[i] is `scale`'s byte
/// for the deviation of post here[i]'s two triangles. The hypotenuse runs
/// along the row, or across it. `below` and `above` are the rows beside. `tolerance` is
/// SourceSurface::postToleranceMetres.
void finestRow(const float* below, const float* here, const float* above, std::int32_t columns,
               bool alongRow, float tolerance, const DeviationScale& scale, std::uint8_t* out);

/// What SourceSurface says of a quarter of all vertices: the greater deviation of the two triangles
/// with legs of two posts that the centre of a square of two cells splits. `centre` points at its
/// height, rows are `stride` apart. The hypotenuse runs from post (-1, -1) to (1, 1) where
/// `isMain`, across it otherwise; as SourceSurface::inside with a floor of 0. Precondition: none of
/// the nine posts is nodata.
SourceSurface::Inside finestCentre(const float* centre, std::ptrdiff_t stride, bool isMain,
                                   double tolerance);

}  // namespace eyrie::terrain
