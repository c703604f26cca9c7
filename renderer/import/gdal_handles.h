// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <cpl_error.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "fabric/vec.h"

/// Owners of what GDAL hands out. Included by the DEM sources of this folder only.
namespace eyrie::import {

template <auto Release>
struct Releaser {
    template <typename Handle>
    void operator()(Handle* handle) const {
        Release(handle);
    }
};
using Dataset = std::unique_ptr<void, Releaser<GDALClose>>;
using SpatialReference = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>,
                                         Releaser<OSRDestroySpatialReference>>;

/// While it lives, on this thread, keeps what GDAL would print, has no sidecar files written, takes
/// damaged JPEGs for unreadable, and gives up servers that send nothing for 20 seconds. What the
/// user has set stays as it is (GDAL_ERROR_ON_LIBJPEG_WARNING, GDAL_HTTP_CONNECTTIMEOUT,
/// GDAL_HTTP_LOW_SPEED_TIME and _LIMIT, from the environment).
class QuietGdal {
public:
    QuietGdal();
    QuietGdal(const QuietGdal&) = delete;
    QuietGdal& operator=(const QuietGdal&) = delete;
    ~QuietGdal();

    /// The first failure since the last call, "" for none.
    std::string takeError() { return std::exchange(error_, {}); }
    /// And the first warning.
    std::string takeWarning() { return std::exchange(warning_, {}); }

private:
    static void CPL_STDCALL note(CPLErr severity, CPLErrorNum, const char* message);

    std::string error_;
    std::string warning_;
    std::array<bool, 5> isSet_{};  ///< by this one, of what it sets
};

/// Pixel to projected metres: (x, y) = origin + column * perColumn + row * perRow, from the outer
/// corner of the first pixel.
struct Georeference {
    fabric::Vec2 origin{0, 0};
    fabric::Vec2 perColumn{1, 0};
    fabric::Vec2 perRow{0, -1};
};

/// As GDAL writes it.
std::array<double, 6> geoTransform(const Georeference& reference);

std::string wktOf(OGRSpatialReferenceH reference);

/// Of coordinates and heights that are of `reference` once they are brought to metres: in feet it
/// would be another place's.
std::string metricWktOf(OGRSpatialReferenceH reference);

/// Null: none.
bool isSameCrs(OGRSpatialReferenceH a, OGRSpatialReferenceH b);

/// Of a raster; null where it says of none. So do GeoTIFFs that have geographic keys but name no
/// CRS: GDAL makes an engineering CRS without a name of that, which is nowhere on earth.
OGRSpatialReferenceH crsOf(GDALDatasetH raster);

/// Whether it says what x and y count: it is of the earth, or in a unit other than the metre, which
/// engineering CRSs of formats that know no other have. Null does not.
bool saysItsUnit(OGRSpatialReferenceH reference);

/// Cuts a raster in degrees, which has so many columns, to 360 of them. What goes on repeats its
/// first ones; and where a raster is wider, be it by a rounding, GDAL's warper knows each longitude
/// by one name only: of one from 0 it would leave out all that is -180 to 0 elsewhere.
void cutToOneTurn(OGRSpatialReferenceH crs, Georeference& reference, int& columns);

/// Latitude beyond which UTM ends and polar stereographic, for all longitudes, begins.
inline constexpr double kUtmLimitDegrees = 84;

/// Options, "NAME=VALUE", for GDAL's warper of a raster in degrees that reaches beyond that
/// latitude. What of it a block needs GDAL tells by the block's rim: where a pole was inside,
/// pixels beside it were missed and stayed open. With these it looks at the block's inside.
std::vector<std::string> polarWarpOptions(GDALDatasetH raster);

/// Whether a raster in degrees has all longitudes, to a few: where one of its rims lies on the map
/// its other does too, and what is between two of its points need not lie between them there.
bool isAroundTheEarth(GDALDatasetH raster);

/// InvalidArgument "path: what".
absl::Status invalid(const std::string& path, const std::string& what);

}  // namespace eyrie::import
