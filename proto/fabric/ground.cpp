// SPDX-License-Identifier: Apache-2.0
#include "fabric/ground.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/look.h"

namespace eyrie::fabric {
namespace {

/// Lifting by less would never end for rounding.
constexpr double kSlackMetres = 1e-6;

/// Along one axis: the cell, the neighbour nearest to the place (itself at the grid's end), and how
/// far that has its say: 0 in the cell's middle half, 1 on the border.
struct Place {
    int cell;
    int neighbour;
    double share;
};

Place placeAt(double coordinate, int cells) {
    const int cell = std::clamp(static_cast<int>(std::floor(coordinate)), 0, cells - 1);
    const double inCell = coordinate - cell;
    const bool isLow = inCell < 0.5;
    const double toBorder = isLow ? inCell : 1 - inCell;
    return {cell, std::clamp(cell + (isLow ? -1 : 1), 0, cells - 1),
            std::clamp(1 - 4 * toBorder, 0.0, 1.0)};
}

double insideCeiling(const GroundGrid& grid, double u, double v) {
    const Place x = placeAt(u, grid.columns);
    const Place y = placeAt(v, grid.rows);
    const auto highest = [&](int column, int row) -> double {
        return grid.highest[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                            static_cast<std::size_t>(column)];
    };
    const double own = highest(x.cell, y.cell);
    const double besideX = std::max(own, highest(x.neighbour, y.cell));
    const double besideY = std::max(own, highest(x.cell, y.neighbour));
    const double corner = std::max({besideX, besideY, highest(x.neighbour, y.neighbour)});
    const double low = own + (besideX - own) * x.share;
    const double high = besideY + (corner - besideY) * x.share;
    return low + (high - low) * y.share;
}

/// By how much the eye is to be lifted, world axes; 0 0 0 where it is fine.
Vec3 lift(const Vec3& eye, const GroundGrid& grid, double exaggeration) {
    const Mat4 worldFromGrid = exaggerated(grid.worldFromGrid, exaggeration);
    const Vec3 place = glm::inverse(Mat3(worldFromGrid)) * (eye - Vec3(worldFromGrid[3]));
    const Vec3 up(grid.worldFromGrid[2]);
    const double worldPerMetre = glm::length(up);
    const double flattened = glm::length(Vec3(worldFromGrid[2])) / worldPerMetre;
    // Upside down the lowest is on top.
    const double ceiling =
        exaggeration < 0 ? -flattened * grid.lowest : flattened * ceilingAt(grid, place.x, place.y);
    const double height = place.z * (exaggeration < 0 ? -flattened : flattened);
    const double missing = (ceiling - height) * worldPerMetre + kGroundClearanceMetres;
    return missing > kSlackMetres ? up * (missing / worldPerMetre) : Vec3(0);
}

}  // namespace

double ceilingAt(const GroundGrid& grid, double u, double v) {
    const double insideU = std::clamp(u, 0.0, static_cast<double>(grid.columns));
    const double insideV = std::clamp(v, 0.0, static_cast<double>(grid.rows));
    const double inside = insideCeiling(grid, insideU, insideV);
    const double beyond = std::hypot(u - insideU, v - insideV);
    if (beyond == 0)
        return inside;
    const auto unit = [&](int axis) { return glm::length(Vec3(grid.worldFromGrid[axis])); };
    const double cellMetres = std::min(unit(0), unit(1)) / unit(2);
    const double relief = *std::max_element(grid.highest.begin(), grid.highest.end()) - grid.lowest;
    return inside - beyond * std::max(cellMetres, relief);
}

Camera aboveGround(const Camera& camera, const std::vector<GroundGrid>& ground, const Look& look) {
    Camera lifted = camera;
    for (const GroundGrid& grid : ground)
        if (!look.hidden.contains(static_cast<std::size_t>(grid.object)))
            lifted.eye += lift(lifted.eye, grid, look.exaggeration);
    if (lifted.eye == camera.eye)
        return camera;
    if (!validate(lifted).ok())
        lifted.target += lifted.eye - camera.eye;
    return lifted;
}

}  // namespace eyrie::fabric
