// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "fabric/camera.h"
#include "fabric/look.h"
#include "fabric/vec.h"

namespace eyrie::fabric {

/// How high and how low one terrain reaches, cell by cell: what keeps a camera above ground without
/// any page.
struct GroundGrid {
    /// World from (cells along x, cells along y, metres of height), affine, not exaggerated.
    Mat4 worldFromGrid{1.0};
    int columns = 0;
    int rows = 0;
    /// Of the source in each cell, metres; row by row. Cells without data are in nobody's way:
    /// their highest is the lowest of all cells, and their lowest the highest.
    std::vector<float> highest;
    std::vector<float> lowest;
    std::int32_t object = 0;  ///< position of the terrain in Scene::objects

    bool operator==(const GroundGrid&) const = default;
};

/// Cells of all grids of a scene together.
inline constexpr int kMaxGroundCells = 256 * 256;

/// A height, in metres of the grid, that the terrain does not reach around (u, v), in cells, when
/// its heights are drawn times `scale`.
///
/// Never below what is on top in the cell, `scale` times its highest or, upside down, its lowest;
/// equal to that in the cell's middle half and rising to that of its neighbours in the quarters
/// beside them, so it is continuous. Beyond the grid it falls by 45 degrees, however flat the
/// terrain is drawn, or by all of the drawn relief in one cell where that is steeper, and has no
/// end.
double ceilingAt(const GroundGrid& grid, double u, double v, double scale = 1);

/// What a camera keeps above the ceiling, in world metres.
inline constexpr double kGroundClearanceMetres = 2;

/// `camera` if its eye is above every ceiling of what `look` shows by the clearance, bit for bit;
/// otherwise with the eye lifted there along the terrain's own axis of height. Continuous in the
/// eye: a camera that is led into the ground slides along it.
///
/// The target stays, so that what is looked at stays in the middle, unless that would look straight
/// up or down, or from the target itself: then it is lifted as well. Promises that the eye is above
/// the source's posts, less a micrometre; what is drawn may be off by its error.
Camera aboveGround(const Camera& camera, const std::vector<GroundGrid>& ground, const Look& look);

}  // namespace eyrie::fabric
