// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "fabric/vec.h"
#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// Longitudes and latitudes, in degrees. Longitudes may be any, going round.
struct GeographicBox {
    fabric::Vec2 low;
    fabric::Vec2 high;

    fabric::Vec2 centre() const { return (low + high) * 0.5; }
    fabric::Vec2 span() const { return high - low; }
};

struct LocalProjection {
    SpatialReference crs;
    /// For people, of a map for wide lands: how far its lengths are off; of others empty.
    std::string caveat;
    /// Of a cylindrical one, the map's width, half of it on either side of 0; of others 0.
    double aroundTheEarth = 0;
};

/// The projected CRS for data that lie in `box` of `geographic`, which is in degrees: up to 30
/// degrees the UTM zone of its centre or, on a sphere and where longitudes are not from Greenwich,
/// transverse Mercator around it, beyond latitude 84 polar stereographic; of what is wider, but
/// within 60 degrees from its centre or from a pole, Lambert's azimuthal equal-area projection
/// around that; and of the rest of the earth the equidistant cylindrical one. J. P. Snyder, Map
/// Projections: A Working Manual (1987), pages 57, 182, 90. Errors: InvalidArgument, naming `path`.
absl::StatusOr<LocalProjection> localProjection(const std::string& path,
                                                OGRSpatialReferenceH geographic,
                                                const GeographicBox& box);

}  // namespace eyrie::import
