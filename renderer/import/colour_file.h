// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// One picture, as it lies on disk.
struct ColourFile {
    std::string path;
    /// Four bands of bytes: red, green, blue and alpha, sRGB, not premultiplied. Blocks are read
    /// and turned when they are asked for. Alpha is 0 where the file has a hole: by its alpha or
    /// mask, or where all its bands are nodata.
    Dataset dataset;
    bool isGeoreferenced = false;
    SpatialReference crs;  ///< null: none
    std::vector<std::string> notes;
};

/// Looks at everything but the pixels (of 16-bit files at these, too). Grey, grey with alpha,
/// palette, RGB and RGBA of 8 or 16 bits; of more bands those tagged red, green and blue, or the
/// first three. 16 bits become 8 by the brightest value, or by the NBITS tag. Errors: those of
/// openRaster; InvalidArgument (not colours).
absl::StatusOr<ColourFile> openColourFile(const std::string& path, QuietGdal& gdal);

}  // namespace eyrie::import
