// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_source.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/degrees_caveat.h"
#include "renderer/import/dem_file.h"
#include "renderer/import/dem_mosaic.h"
#include "renderer/import/layered_dems.h"
#include "renderer/import/length_caveat.h"

namespace eyrie::import {
namespace {

/// One raster on the grid it has.
absl::StatusOr<DemSource> openAsItIs(DemFile file) {
    RETURN_IF_ERROR(checkSize(file.path, file.columns, file.rows));
    DemSource source;
    source.notes = file.notes;
    Georeference reference = file.reference;
    if (file.crs) {
        source.crsWkt = metricWktOf(file.crs.get());
        const double metres = OSRGetLinearUnits(file.crs.get(), nullptr);
        if (metres != 1 && metres > 0 && std::isfinite(metres)) {
            reference = {reference.origin * metres, reference.perColumn * metres,
                         reference.perRow * metres};
            source.notes.push_back(fmt::format("CRS unit of {} m turned to metres", metres));
        }
    }
    const int columns = file.columns;
    const int rows = file.rows;
    std::string caveat = lengthCaveat(file.crs.get(), file.reference, columns, rows);
    if (!caveat.empty())
        source.notes.push_back(std::move(caveat));
    const bool isKnown = !file.isGeoreferenced || saysItsUnit(file.crs.get());
    std::vector<DemLayer> layers(1);
    layers.front().box = {0, 0, columns, rows};
    layers.front().files.push_back(std::move(file));
    source.posts = layeredDems(std::move(layers), reference, columns, rows);
    source.mayBeDegrees = !isKnown && mayBeDegrees(source.posts->frame());
    return source;
}

}  // namespace

absl::StatusOr<DemSource> openDems(const std::vector<std::string>& paths,
                                   const ImportControl& control, const std::string& hashFolder) {
    QuietGdal gdal;
    GDALSetCacheMax64(static_cast<GIntBig>(kGdalCacheBytes));
    std::vector<DemFile> files;
    std::uint64_t hash = 0;
    bool isRounded = false;
    for (const std::string& path : paths) {
        RETURN_IF_ERROR(control.check());
        control.report("checking",
                       static_cast<double>(files.size()) / static_cast<double>(paths.size()));
        ASSIGN_OR_RETURN(DemFile file, openDemFile(path, gdal, hashFolder, control.stop));
        hash = files.empty() ? file.hash : hash * 0x9e3779b97f4a7c15 + file.hash;
        isRounded = isRounded || file.isRounded;
        files.push_back(std::move(file));
    }
    control.report("checking", 1);
    if (files.empty())
        return absl::InvalidArgumentError("no elevation model was named");
    const std::string name = nameOf(files);
    const bool isOne = files.size() == 1 && !files.front().isGeographic();
    if (files.size() == 1)
        RETURN_IF_ERROR(checkSize(files.front().path, files.front().columns, files.front().rows));
    ASSIGN_OR_RETURN(DemSource source, isOne ? openAsItIs(std::move(files.front()))
                                             : mosaicOf(std::move(files), gdal));
    RETURN_IF_ERROR(checkReach(name, source.posts->frame()));
    source.hash = hash;
    source.isRounded = isRounded;
    return source;
}

}  // namespace eyrie::import
