// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <gdal_priv.h>

namespace eyrie::import {

/// Whether a raster is decoded by whole rows, as PNG, JPEG and GeoTIFF in strips are: who reads
/// some of its columns reads all of them.
bool isInStrips(GDALRasterBand& band);

/// Bytes of one of its rows as GDAL's cache keeps it, masks included.
std::uint64_t rowBytes(GDALDataset& dataset);

/// Has the strips of a raster decoded from the first to the last, in whatever order they are asked
/// for, and each once as long as GDAL's cache holds `rows` of them: a decoder such as PNG's begins
/// anew with the first row to go back by one.
class StripOrder {
public:
    StripOrder() = default;
    StripOrder(std::vector<GDALRasterBand*> bands, int rows)
        : bands_(std::move(bands)), rows_(rows) {}

    /// To be called before rows `row` and on, up to `end`, are read.
    void prepare(int row, int end);

private:
    std::vector<GDALRasterBand*> bands_;
    int rows_ = 0;  ///< that are wanted at a time; 0: as they are asked for
    int next_ = 0;  ///< what is above has been read, or is not wanted
};

}  // namespace eyrie::import
