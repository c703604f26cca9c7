// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gdal_handles.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

namespace eyrie::import {
namespace {

struct Setting {
    const char* name;
    const char* value;
};
/// Without the second one GDAL makes grey of what a JPEG lacks at its end, and without the last
/// three it waits for a server that has stopped to answer for ever.
constexpr std::array kSettings = {
    Setting{"CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO"},
    Setting{"GDAL_ERROR_ON_LIBJPEG_WARNING", "YES"},
    Setting{"GDAL_HTTP_CONNECTTIMEOUT", "10"},
    Setting{"GDAL_HTTP_LOW_SPEED_TIME", "20"},
    Setting{"GDAL_HTTP_LOW_SPEED_LIMIT", "100"},
};

}  // namespace

QuietGdal::QuietGdal() {
    static std::once_flag registered;
    std::call_once(registered, GDALAllRegister);
    CPLPushErrorHandlerEx(&QuietGdal::note, this);
    static_assert(kSettings.size() == std::tuple_size_v<decltype(isSet_)>);
    for (std::size_t k = 0; k < kSettings.size(); ++k)
        if (CPLGetConfigOption(kSettings[k].name, nullptr) == nullptr) {
            CPLSetThreadLocalConfigOption(kSettings[k].name, kSettings[k].value);
            isSet_[k] = true;
        }
    CPLErrorReset();
}

QuietGdal::~QuietGdal() {
    for (std::size_t k = 0; k < kSettings.size(); ++k)
        if (isSet_[k])
            CPLSetThreadLocalConfigOption(kSettings[k].name, nullptr);
    CPLPopErrorHandler();
}

void QuietGdal::note(CPLErr severity, CPLErrorNum, const char* message) {
    auto& self = *static_cast<QuietGdal*>(CPLGetErrorHandlerUserData());
    if (severity >= CE_Failure && self.error_.empty())
        self.error_ = message;
    if (severity == CE_Warning && self.warning_.empty())
        self.warning_ = message;
}

std::array<double, 6> geoTransform(const Georeference& g) {
    return {g.origin.x, g.perColumn.x, g.perRow.x, g.origin.y, g.perColumn.y, g.perRow.y};
}

std::string wktOf(OGRSpatialReferenceH reference) {
    char* text = nullptr;
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    OSRExportToWktEx(reference, &text, options);
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

std::string metricWktOf(OGRSpatialReferenceH reference) {
    const bool isAcross = OSRGetLinearUnits(reference, nullptr) == 1;
    const bool isUp = OSRGetTargetLinearUnits(reference, "VERT_CS", nullptr) == 1;
    if (isAcross && isUp)
        return wktOf(reference);
    const SpatialReference metric(OSRClone(reference));
    OGRSpatialReference::FromHandle(metric.get())->StripVertical();
    if (isAcross)
        return wktOf(metric.get());
    const std::string name = fmt::format("{} in metres", OSRGetName(metric.get()));
    if (OSRSetLinearUnitsAndUpdateParameters(metric.get(), "metre", 1) != OGRERR_NONE)
        return wktOf(reference);
    if (OSRIsProjected(metric.get()) != 0)
        OSRSetAttrValue(metric.get(), "PROJCS", name.c_str());
    return wktOf(metric.get());
}

OGRSpatialReferenceH crsOf(GDALDatasetH raster) {
    const OGRSpatialReferenceH crs = GDALGetSpatialRef(raster);
    if (crs == nullptr || OSRIsLocal(crs) == 0 || OSRGetLinearUnits(crs, nullptr) != 1)
        return crs;
    const char* const name = OSRGetName(crs);
    const bool isNamed = name != nullptr && !EQUAL(name, "unnamed") && !EQUAL(name, "unknown");
    return isNamed ? crs : nullptr;
}

bool saysItsUnit(OGRSpatialReferenceH reference) {
    return reference != nullptr &&
           (OSRIsLocal(reference) == 0 || OSRGetLinearUnits(reference, nullptr) != 1);
}

void cutToOneTurn(OGRSpatialReferenceH crs, Georeference& reference, int& columns) {
    constexpr double kTurn = 360;
    const double pixel = std::abs(reference.perColumn.x);
    if (crs == nullptr || OSRIsGeographic(crs) == 0 || reference.perColumn.y != 0 ||
        pixel * columns <= kTurn)
        return;
    constexpr double kPixelsOfRounding = 1e-3;
    constexpr double kRounding = 1e-14;  // of longitudes far from 0
    columns = std::max(1, static_cast<int>(kTurn / pixel + kPixelsOfRounding));
    const double most = kTurn / columns * (1 - kRounding);
    if (pixel > most)
        reference.perColumn.x = std::copysign(most, reference.perColumn.x);
}

bool isSameCrs(OGRSpatialReferenceH a, OGRSpatialReferenceH b) {
    return (a == nullptr && b == nullptr) || (a != nullptr && b != nullptr && OSRIsSame(a, b) != 0);
}

namespace {

/// Of a raster in degrees.
std::optional<std::array<double, 6>> degreesOf(GDALDatasetH raster) {
    const OGRSpatialReferenceH crs = GDALGetSpatialRef(raster);
    std::array<double, 6> t{};
    if (crs == nullptr || OSRIsGeographic(crs) == 0 ||
        GDALGetGeoTransform(raster, t.data()) != CE_None)
        return std::nullopt;
    return t;
}

}  // namespace

bool isAroundTheEarth(GDALDatasetH raster) {
    constexpr double kLeastDegrees = 355;
    const auto t = degreesOf(raster);
    return t && std::abs((*t)[1]) * GDALGetRasterXSize(raster) >= kLeastDegrees;
}

std::vector<std::string> polarWarpOptions(GDALDatasetH raster) {
    const auto t = degreesOf(raster);
    if (!t)
        return {};
    const double last = (*t)[3] + (*t)[5] * GDALGetRasterYSize(raster);
    if (std::max(std::abs((*t)[3]), std::abs(last)) <= kUtmLimitDegrees)
        return {};
    return {"SAMPLE_GRID=YES", "SAMPLE_STEPS=129"};  // every row of a block of 128
}

absl::Status invalid(const std::string& path, const std::string& what) {
    return absl::InvalidArgumentError(fmt::format("{}: {}", path, what));
}

}  // namespace eyrie::import
