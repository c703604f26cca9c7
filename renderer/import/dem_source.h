// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/height_source.h"
#include "renderer/import/progress.h"

namespace eyrie::import {

/// Elevation models on disk, opened as one.
struct DemSource {
    std::unique_ptr<HeightSource> posts;
    std::string crsWkt;              ///< of the posts' x and y; empty: the source has none
    std::uint64_t hash = 0;          ///< of all bytes of all files, in their order
    std::vector<std::string> notes;  ///< what was assumed or changed, for people
    bool isRounded = false;          ///< of some file: DemFile::isRounded
    bool mayBeDegrees = false;       ///< no CRS says that they are not, and they are not too large
};

/// Opens the first band of any rasters GDAL reads; `.gz` and `.zip` are looked into. Pixels are
/// read when posts are asked for, so what is held in memory does not grow with the files.
///
/// Posts are pixel centres. One raster in a projected CRS, or none, keeps its grid, rotation
/// included, with units turned to metres. A geographic one is reprojected to what suits
/// its size and place (local_projection.h; as a rule the UTM zone of its centre up to 30 degrees),
/// bilinearly, at the spacing GDAL suggests; of more than 360 degrees what goes on is left out, and
/// so are rows beyond the poles, with a note.
///
/// Several are laid over each other: the CRS is that of the finest projected one, or what
/// suits all of them where all are geographic, the short way round; the grid is that of the
/// finest. Those on that grid already keep their posts as they are; the others are resampled
/// bilinearly, tiles of one grid of their own as one raster, so that no post between rasters that
/// touch is open, and up to their rim towards what lies beside them (rimmed_dem.h). Where some
/// overlap the finest with data wins, among equally fine ones the one named last. What none covers
/// is nodata.
///
/// Each raster's own scale, offset and foot units (the band's or, where it has none, those of its
/// CRS's heights) are applied; vertical datums are left as they are, with a note where they differ,
/// and so are values whose CRS is of depths. Nodata: the band's tag, its mask or an alpha band,
/// NaN, infinities, magnitudes from 1e30, heights beyond what scenes reach (fabric/scene_reach.h),
/// and -32768 in 16-bit rasters; what of this the file does not itself call nodata is among the
/// posts' findings.
///
/// Reports as "checking" while it reads the files for their hash, unless that is in `hashFolder`
/// (fileHash; empty: there is none). Errors, naming file and field:
/// NotFound, InvalidArgument (no raster, not heights, less than 2 x 2 posts, no usable
/// georeference or one by control points, a CRS of no map, not to be brought together, beyond what
/// scenes reach), ResourceExhausted (more posts than an .eyt holds). Posts that cannot be read are
/// DataLoss.
/// Nothing is printed, no file is written.
absl::StatusOr<DemSource> openDems(const std::vector<std::string>& paths,
                                   const ImportControl& control,
                                   const std::string& hashFolder = "");

}  // namespace eyrie::import
