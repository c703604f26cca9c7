// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <absl/status/statusor.h>

#include "fabric/vec.h"
#include "renderer/import/colour_file.h"
#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/imagery/texture_pyramid.h"

namespace eyrie::import {

/// Where the texels of a terrain lie in its CRS.
struct TexelGrid {
    terrain::GridFrame frame;  ///< in units of the CRS
    SpatialReference crs;      ///< null: none

    /// From the corner of the first texel; texels of 2^-texelShift posts.
    Georeference reference(int texelShift) const;
};

/// Where a picture lies on a terrain.
struct ColourPlace {
    fabric::Vec2 low;  ///< posts; all of the picture is between these
    fabric::Vec2 high;
    double pixelPosts = 1;  ///< the shorter side of a pixel
    /// Some of what lies on the terrain is not found from there, as where a map goes on past 180
    /// degrees.
    bool isCutOff = false;
};

/// Errors: InvalidArgument (no way from the file's CRS to the terrain's).
absl::StatusOr<ColourPlace> placeOf(const ColourFile& file, const TexelGrid& grid, QuietGdal& gdal);

/// The most rows of a picture that one row of texture tiles of `box` takes, and what is read with
/// them. Errors: as placeOf.
absl::StatusOr<int> rowsAtOnce(const ColourFile& file, const TexelGrid& grid, int texelShift,
                               const terrain::TexelRect& box, QuietGdal& gdal);

/// A lazily computed view of `file`, which must outlive it, on the texels of `box`: four bands like
/// the file's. Errors: InvalidArgument.
absl::StatusOr<Dataset> warpedTo(const ColourFile& file, const TexelGrid& grid, int texelShift,
                                 const terrain::TexelRect& box, QuietGdal& gdal);

}  // namespace eyrie::import
