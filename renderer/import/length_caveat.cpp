// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/length_caveat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <type_traits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace eyrie::import {
namespace {

using fabric::Vec2;
using fabric::Vec3;

using Transformation = std::unique_ptr<std::remove_pointer_t<OGRCoordinateTransformationH>,
                                       Releaser<OCTDestroyCoordinateTransformation>>;

/// Lengths on the ellipsoid of a projected CRS.
class Ground {
public:
    explicit Ground(OGRSpatialReferenceH crs) : geographic_(OSRCloneGeogCS(crs)) {
        const SpatialReference map(OSRClone(crs));
        for (const OGRSpatialReferenceH one : {map.get(), geographic_.get()})
            OSRSetAxisMappingStrategy(one, OAMS_TRADITIONAL_GIS_ORDER);
        transformation_.reset(OCTNewCoordinateTransformation(map.get(), geographic_.get()));
        radians_ = OSRGetAngularUnits(geographic_.get(), nullptr);
        semiMajor_ = OSRGetSemiMajor(geographic_.get(), nullptr);
        const double inverse = OSRGetInvFlattening(geographic_.get(), nullptr);
        const double flattening = inverse == 0 ? 0 : 1 / inverse;
        squaredEccentricity_ = flattening * (2 - flattening);
    }

    /// Between two places of the map; NaN where one of them is not on it.
    double metresBetween(const Vec2& a, const Vec2& b) const {
        const double chord = glm::distance(placeOf(a), placeOf(b));
        return 2 * semiMajor_ * std::asin(std::min(chord / (2 * semiMajor_), 1.0));
    }

private:
    /// Geocentric, metres.
    Vec3 placeOf(Vec2 at) const {
        if (!transformation_ ||
            OCTTransform(transformation_.get(), 1, &at.x, &at.y, nullptr) == FALSE)
            return Vec3(NAN);
        const Vec2 angle = at * radians_;
        const double sine = std::sin(angle.y);
        const double normal = semiMajor_ / std::sqrt(1 - squaredEccentricity_ * sine * sine);
        return {normal * std::cos(angle.y) * std::cos(angle.x),
                normal * std::cos(angle.y) * std::sin(angle.x),
                normal * (1 - squaredEccentricity_) * sine};
    }

    SpatialReference geographic_;
    Transformation transformation_;
    double radians_ = 0;  ///< of a unit of `geographic_`
    double semiMajor_ = 0;
    double squaredEccentricity_ = 0;
};

}  // namespace

std::string lengthCaveat(OGRSpatialReferenceH crs, const Georeference& g, int columns, int rows) {
    if (crs == nullptr || OSRIsProjected(crs) == 0)
        return "";
    const Ground ground(crs);
    const double metres = OSRGetLinearUnits(crs, nullptr);
    const Vec2 span(columns, rows);
    const auto onMap = [&](const Vec2& post) {
        return g.origin + g.perColumn * post.x + g.perRow * post.y;
    };
    // Not less than this share of the grid: PROJ's inverses are exact to a fraction of a
    // millimetre.
    constexpr double kStep = 1.0 / 64;
    constexpr std::array kWays = {Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(1, -1)};
    double worst = 0;
    for (int k = 0; k < 9; ++k)
        for (const Vec2& way : kWays) {
            const Vec2 middle = Vec2(k % 3, k / 3) * 0.5;
            const Vec2 from = onMap(glm::clamp(middle - way * kStep, 0.0, 1.0) * span);
            const Vec2 to = onMap(glm::clamp(middle + way * kStep, 0.0, 1.0) * span);
            const double off =
                glm::distance(from, to) * metres / ground.metresBetween(from, to) - 1;
            if (std::isfinite(off))
                worst = std::max(worst, std::abs(off));
        }
    constexpr double kWorthTelling = 0.01;
    return worst > kWorthTelling
               ? fmt::format("lengths in {} are up to {:.1f} % too great or too small",
                             OSRGetName(crs), 100 * worst)
               : "";
}

}  // namespace eyrie::import
