// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/crs_text.h"

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

bool isSameCrs(const std::string& wkt, const std::string& otherWkt) {
    if (wkt == otherWkt)
        return true;
    const QuietGdal gdal;
    const SpatialReference one(OSRNewSpatialReference(wkt.c_str()));
    const SpatialReference other(OSRNewSpatialReference(otherWkt.c_str()));
    return one && other && isSameCrs(one.get(), other.get());
}

}  // namespace eyrie::import
