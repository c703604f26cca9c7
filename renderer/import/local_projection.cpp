// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/local_projection.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>
#include <ogr_srs_api.h>

namespace eyrie::import {
namespace {

using fabric::Vec2;

constexpr double kMostUtmDegrees = 30;
constexpr double kMostFromCentreDegrees = 60;

/// Between two places on a sphere, degrees.
double degreesBetween(const Vec2& a, const Vec2& b) {
    const Vec2 from = glm::radians(a);
    const Vec2 to = glm::radians(b);
    const double cosine = std::sin(from.y) * std::sin(to.y) +
                          std::cos(from.y) * std::cos(to.y) * std::cos(to.x - from.x);
    return glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
}

/// Of what is at most half around the earth, the farthest is at its western and eastern rim.
double farthestFrom(const Vec2& centre, const GeographicBox& box) {
    if (box.span().x > 180)
        return 180;
    double farthest = 0;
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
        const double latitude = box.low.y + box.span().y * i / kSteps;
        farthest = std::max({farthest, degreesBetween(centre, {box.low.x, latitude}),
                             degreesBetween(centre, {centre.x, latitude})});
    }
    return farthest;
}

double within180(double longitude) { return longitude - 360 * std::floor((longitude + 180) / 360); }

/// Of the CRS that `geographic` has places in.
SpatialReference named(const std::string& name, OGRSpatialReferenceH geographic) {
    SpatialReference crs(OSRNewSpatialReference(nullptr));
    OSRSetProjCS(crs.get(), name.c_str());
    return OSRCopyGeogCSFrom(crs.get(), geographic) == OGRERR_NONE ? std::move(crs) : nullptr;
}

LocalProjection transverseMercator(OGRSpatialReferenceH geographic, const Vec2& centre) {
    LocalProjection result{named(fmt::format("Transverse Mercator around {:.4g}, {:.4g}",
                                             within180(centre.x), centre.y),
                                 geographic),
                           {}};
    if (result.crs &&
        OSRSetTM(result.crs.get(), centre.y, within180(centre.x), 1, 0, 0) != OGRERR_NONE)
        result.crs = nullptr;
    return result;
}

LocalProjection utm(OGRSpatialReferenceH geographic, const Vec2& centre) {
    // Zones count from Greenwich, and PROJ has them of ellipsoids only.
    if (OSRGetPrimeMeridian(geographic, nullptr) != 0 ||
        OSRGetInvFlattening(geographic, nullptr) == 0)
        return transverseMercator(geographic, centre);
    const int zone = std::clamp(static_cast<int>((within180(centre.x) + 180) / 6) + 1, 1, 60);
    const bool isNorth = centre.y >= 0;
    LocalProjection result{
        named(fmt::format("UTM zone {}{}", zone, isNorth ? 'N' : 'S'), geographic), {}};
    if (result.crs && OSRSetUTM(result.crs.get(), zone, isNorth ? 1 : 0) != OGRERR_NONE)
        result.crs = nullptr;
    return result;
}

/// With UPS's scale and origin, of whatever body.
LocalProjection polarStereographic(OGRSpatialReferenceH geographic, bool isNorth) {
    LocalProjection result{named(isNorth ? "UPS North" : "UPS South", geographic), {}};
    if (result.crs &&
        OSRSetPS(result.crs.get(), isNorth ? 90 : -90, 0, 0.994, 2e6, 2e6) != OGRERR_NONE)
        result.crs = nullptr;
    return result;
}

/// Snyder, page 185: lengths that far from the centre are 1 / cos(c / 2) of what they are across,
/// and as much too short along.
LocalProjection azimuthal(OGRSpatialReferenceH geographic, const Vec2& centre, double farthest) {
    LocalProjection result{
        named(fmt::format("Lambert azimuthal equal-area around {:.4g}, {:.4g}", within180(centre.x),
                          centre.y),
              geographic),
        fmt::format("at its rim, {:.0f} degrees from its centre, lengths are up to {:.2g} % too "
                    "great or too small",
                    farthest, 100 * (1 / std::cos(glm::radians(farthest) / 2) - 1))};
    if (result.crs &&
        OSRSetLAEA(result.crs.get(), centre.y, within180(centre.x), 0, 0) != OGRERR_NONE)
        result.crs = nullptr;
    return result;
}

LocalProjection cylindrical(OGRSpatialReferenceH geographic, const Vec2& centre) {
    LocalProjection result{named("Equidistant cylindrical", geographic),
                           "lengths from west to east are too great away from the equator, twice "
                           "as great at 60 degrees"};
    if (result.crs &&
        OSRSetEquirectangular(result.crs.get(), 0, within180(centre.x), 0, 0) != OGRERR_NONE)
        result.crs = nullptr;
    if (result.crs)
        result.aroundTheEarth = 2 * M_PI * OSRGetSemiMajor(result.crs.get(), nullptr);
    return result;
}

LocalProjection projectionFor(OGRSpatialReferenceH geographic, const GeographicBox& box) {
    const Vec2 centre = box.centre();
    const Vec2 span = box.span();
    if (std::abs(centre.y) > kUtmLimitDegrees && span.y <= kMostUtmDegrees)
        return polarStereographic(geographic, centre.y > 0);
    if (span.x <= kMostUtmDegrees && span.y <= kMostUtmDegrees)
        return utm(geographic, centre);
    const double farthest = farthestFrom(centre, box);
    if (farthest <= kMostFromCentreDegrees)
        return azimuthal(geographic, centre, farthest);
    const double fromPole = 90 - std::min(std::abs(box.low.y), std::abs(box.high.y));
    if (box.low.y * box.high.y > 0 && fromPole <= kMostFromCentreDegrees)
        return azimuthal(geographic, {centre.x, centre.y > 0 ? 90 : -90}, fromPole);
    return cylindrical(geographic, centre);
}

}  // namespace

absl::StatusOr<LocalProjection> localProjection(const std::string& path,
                                                OGRSpatialReferenceH geographic,
                                                const GeographicBox& box) {
    if (std::abs(box.centre().y) > 90)
        return invalid(path, fmt::format("lies around latitude {:.1f}; give it the right "
                                         "georeference (gdal_edit.py)",
                                         box.centre().y));
    LocalProjection result = projectionFor(geographic, box);
    if (!result.crs)
        return invalid(path,
                       "its geographic CRS cannot be projected; reproject it with gdalwarp first");
    OSRSetAxisMappingStrategy(result.crs.get(), OAMS_TRADITIONAL_GIS_ORDER);
    return result;
}

}  // namespace eyrie::import
