// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// A pixel that cannot be a height, in a file that does not call it nodata.
struct ImpossibleHeight {
    int column = 0;
    int row = 0;
    double value = 0;  ///< as the file has it, or what its scale and offset make of it
};

/// One file of heights, as it lies on disk.
struct DemFile {
    std::string path;
    /// One band of float heights in metres, NaN for nodata: scale, offset, unit and mask are done
    /// with. Blocks are read and turned when they are asked for.
    Dataset dataset;
    int columns = 0;
    int rows = 0;
    int blockColumns = 1;  ///< of what of the file is read at once
    int blockRows = 1;
    int valueBytes = 4;      ///< of one in the file, and of its mask
    Georeference reference;  ///< in units of the CRS, degrees of a geographic one
    bool isGeoreferenced = false;
    SpatialReference crs;    ///< null: none
    std::uint64_t hash = 0;  ///< XXH64 of the bytes of all its files
    /// Whether heights may have more digits than floats have, of which they are the nearest.
    bool isRounded = false;
    std::vector<std::string> notes;
    /// The first of those read so far; they become nodata. Never null.
    std::shared_ptr<const std::optional<ImpossibleHeight>> impossible;

    bool isGeographic() const;
};

/// In units of the CRS.
fabric::Vec2 centreOf(const DemFile& file);

/// Looks at everything but the pixels. Errors: those of openRaster; InvalidArgument (not heights,
/// no usable georeference); Cancelled.
absl::StatusOr<DemFile> openDemFile(const std::string& path, QuietGdal& gdal,
                                    const std::string& hashFolder, const std::stop_token& stop);

}  // namespace eyrie::import
