// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
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
    /// The largest value outside of holes, at least 0, by findMost(), of a picture of more than 8
    /// bits that does not say what the most may be: nothing may be read before turnToBytes().
    std::optional<double> brightest;
    std::uint64_t wholeBytes = 0;  ///< wholeDecodingBytes of it
    std::vector<std::string> notes;
};

/// Looks at everything but the pixels. Grey, grey with alpha, palette, RGB and RGBA of 8 or 16
/// bits; of more bands those tagged red, green and blue, or the first three. 16 bits become 8 by
/// the NBITS tag, or by findMost() and turnToBytes(). Errors: those of openRaster; InvalidArgument
/// (not colours, or of several depths).
absl::StatusOr<ColourFile> openColourFile(const std::string& path, QuietGdal& gdal);

/// Told how far a look at all pixels is, 0 to 1; an error calls it off.
using Watch = std::function<absl::Status(double fraction)>;

/// Before anything is read: looks for the most that values of other than 8 bits come to where no
/// tag says it, of colours and of alpha, whose most is opaque. Of others it looks at nothing.
absl::Status findMost(ColourFile& file, const Watch& watch);

/// Says what value of a picture with `brightest` is 255: that of all pictures beside it, so that
/// one colour is the same in each.
void turnToBytes(ColourFile& file, double most);

/// Rows that are read at once of a picture in strips (strip_order.h), all that is asked for or not.
inline constexpr int kStripPieceRows = 128;
/// What GDAL's cache has of each row of a picture in strips; 0: it is in tiles.
std::uint64_t stripRowBytes(const ColourFile& file);
/// Has such a picture decoded once, while GDAL's cache keeps so many rows (see StripOrder).
void readInOrder(ColourFile& file, int rows);

}  // namespace eyrie::import
