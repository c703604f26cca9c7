// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <gdal.h>

namespace eyrie::import {

/// Bytes of memory, about, that GDAL takes of a raster that it can only decode whole, from the
/// first pixel that is read until the raster is closed: of JPEG in several scans (progressive),
/// WebP, GIF, and JPEG 2000 of one tile. 0 of others, and of those that a virtual raster names.
std::uint64_t wholeDecodingBytes(GDALDatasetH raster);

}  // namespace eyrie::import
