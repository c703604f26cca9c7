// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/raster_file.h"

#include <fmt/format.h>

namespace eyrie::import {

std::string gdalPath(const std::string& path) {
    if (path.starts_with("/vsi"))
        return path;
    if (path.ends_with(".gz"))
        return "/vsigzip/" + path;
    if (path.ends_with(".zip"))
        return "/vsizip/" + path;
    return path;
}

absl::StatusOr<Dataset> openRaster(const std::string& path, const char* wanted, QuietGdal& gdal) {
    Dataset dataset(GDALOpenEx(gdalPath(path).c_str(),
                               GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                               nullptr, nullptr));
    if (!dataset)
        return invalid(path,
                       fmt::format("is no raster that GDAL {} reads ({}); give {}",
                                   GDALVersionInfo("RELEASE_NAME"), gdal.takeError(), wanted));
    if (GDALGetRasterCount(dataset.get()) < 1)
        return invalid(path,
                       "has no raster band of its own; name one of its subdatasets instead "
                       "(gdalinfo lists them)");
    return dataset;
}

}  // namespace eyrie::import
