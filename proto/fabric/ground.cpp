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

double insideCeiling(const GroundGrid& grid, double u, double v, double scale) {
    // Upside down the lowest is on top.
    const bool isUpsideDown = scale < 0;
    const std::vector<float>& heights = isUpsideDown ? grid.lowest : grid.highest;
    const Place x = placeAt(u, grid.columns);
    const Place y = placeAt(v, grid.rows);
    const auto top = [&](int column, int row) -> double {
        const double height =
            heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                    static_cast<std::size_t>(column)];
        return isUpsideDown ? -height : height;
    };
    const double own = top(x.cell, y.cell);
    const double besideX = std::max(own, top(x.neighbour, y.cell));
    const double besideY = std::max(own, top(x.cell, y.neighbour));
    const double corner = std::max({besideX, besideY, top(x.neighbour, y.neighbour)});
    const double low = own + (besideX - own) * x.share;
    const double high = besideY + (corner - besideY) * x.share;
    return std::abs(scale) * (low + (high - low) * y.share);
}

/// By how much the eye is to be lifted, world axes; 0 0 0 where it is fine.
Vec3 lift(const Vec3& eye, const GroundGrid& grid, double exaggeration) {
    const Vec3 place = glm::inverse(Mat3(grid.worldFromGrid)) * (eye - Vec3(grid.worldFromGrid[3]));
    const Vec3 up(grid.worldFromGrid[2]);
    const double worldPerMetre = glm::length(up);
    const Vec3 drawnUp(exaggerated(grid.worldFromGrid, exaggeration)[2]);
    const double scale = glm::dot(drawnUp, up) / glm::dot(up, up);
    const double ceiling = ceilingAt(grid, place.x, place.y, scale);
    const double missing = (ceiling - place.z) * worldPerMetre + kGroundClearanceMetres;
    return missing > kSlackMetres ? up * (missing / worldPerMetre) : Vec3(0);
}

}  // namespace

double ceilingAt(const GroundGrid& grid, double u, double v, double scale) {
    const double insideU = std::clamp(u, 0.0, static_cast<double>(grid.columns));
    const double insideV = std::clamp(v, 0.0, static_cast<double>(grid.rows));
    const double inside = insideCeiling(grid, insideU, insideV, scale);
    const double beyond = std::hypot(u - insideU, v - insideV);
    if (beyond == 0)
        return inside;
    const auto unit = [&](int axis) { return glm::length(Vec3(grid.worldFromGrid[axis])); };
    const double cellMetres = std::min(unit(0), unit(1)) / unit(2);
    const double relief = *std::max_element(grid.highest.begin(), grid.highest.end()) -
                          *std::min_element(grid.lowest.begin(), grid.lowest.end());
    return inside - beyond * std::max(cellMetres, std::abs(scale) * relief);
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
