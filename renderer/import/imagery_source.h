// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/image.h"
#include "renderer/import/progress.h"
#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/imagery/texture_pyramid.h"

namespace eyrie::import {

/// Pictures on disk, laid over a terrain as one. One thread at a time.
class ImagerySource {
public:
    virtual ~ImagerySource() = default;

    virtual const terrain::TexturePyramid& pyramid() const = 0;
    /// Rows are stored from the last to the first: quicker read in that order.
    virtual bool isLastRowFirst() const = 0;
    /// False where no picture lies in a window of the finest level: all of it is a hole.
    virtual bool mayHave(const terrain::TexelRect& window) const = 0;
    /// The texels of a window of the finest level, row by row, those outside of the level as its
    /// nearest; alpha 0 where there is no picture. Errors: DataLoss.
    virtual absl::Status read(const terrain::TexelRect& window, std::span<fabric::Rgba> out) = 0;
    /// What was found in the texels read so far, for people.
    virtual std::vector<std::string> findings() const = 0;
    /// Bytes of memory that reading takes beside what GDAL's cache has otherwise.
    virtual std::uint64_t readingBytes() const = 0;
};

/// What pictures were opened as.
struct OpenImagery {
    std::unique_ptr<ImagerySource> texels;
    std::vector<std::string> notes;  ///< what was assumed or changed, for people
};

/// Opens any pictures GDAL reads (see openColourFile) for a terrain on `frame`, in metres of
/// `crsWkt` ("" for none). Pixels are read and warped, bilinearly, when texels are asked for.
///
/// Texels are a power of two smaller or larger than posts: at most 2^(1/4) of the shorter side of
/// the finest picture's pixels, as they are on average on the terrain. Where pictures overlap, the
/// finest that has no hole there wins, among those within 1 % of the finest of them the one named
/// last. A picture without a georeference is stretched over the whole terrain, north up; one
/// without a CRS is taken to be in the terrain's.
///
/// `memoryBytes` is what reading may take, and what else needs memory while it does. Pictures that
/// GDAL decodes whole have to fit. Pictures in strips are decoded about once where GDAL's cache
/// holds the rows that a row of texture tiles takes: it grows for them, by a third of what is left
/// at most. Notes say of which it cannot.
///
/// Of pictures of more than 8 bits that do not say what the most may be all pixels are read first,
/// which is reported as "looking for the brightest".
///
/// Errors, naming the file: NotFound, InvalidArgument (no picture, not to be brought to the
/// terrain, none overlaps it), ResourceExhausted (more texels than an .eyt holds; pictures that are
/// decoded whole and do not fit), Cancelled.
absl::StatusOr<OpenImagery> openImagery(const std::vector<std::string>& paths,
                                        const terrain::GridFrame& frame, const std::string& crsWkt,
                                        std::uint64_t memoryBytes, const ImportControl& control);

}  // namespace eyrie::import
