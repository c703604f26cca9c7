// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "renderer/import/dem_file.h"
#include "renderer/import/dem_warp.h"
#include "renderer/import/height_source.h"

namespace eyrie::import {

/// What GDAL keeps of blocks that it has read.
inline constexpr std::uint64_t kGdalCacheBytes = std::uint64_t{48} << 20;

/// For messages about all of them. Precondition: there is one.
std::string nameOf(const std::vector<DemFile>& files);

/// One raster of a mosaic, as pixels of the mosaic.
struct DemLayer {
    std::vector<DemFile> files;  ///< one, or several of one grid, best first
    Dataset joined;              ///< null: of one
    Dataset warped;              ///< null: the file's own pixels
    /// With what lies beside it, see rimmed_dem.h: by the others' own posts, by these with such
    /// rims, and that warped. Null where nothing lies beside it.
    Dataset rimmed;
    Dataset twiceRimmed;
    Dataset rimmedWarped;
    int rimReach = 0;  ///< how many posts from where it has no data its rim may tell
    PixelBox box;

    GDALDatasetH source() const { return joined ? joined.get() : files.front().dataset.get(); }
    GDALDatasetH posts() const { return warped ? warped.get() : source(); }
};

/// Area of a pixel, below 0 where rows go towards lower y while columns go towards higher x.
double determinant(const Georeference& reference);

/// InvalidArgument or ResourceExhausted where a terrain of so many posts cannot be. `grid` says
/// which they are, where they are not the raster's own, such as " in WGS 84 / UTM zone 32N".
absl::Status checkSize(const std::string& path, std::int64_t columns, std::int64_t rows,
                       const std::string& grid = {});

/// InvalidArgument where posts lie beyond what scenes reach. `path` is for the message.
absl::Status checkReach(const std::string& path, const terrain::GridFrame& frame);

/// Layers as posts, the best one with data first. `reference` is in metres, of a raster of
/// `columns` x `rows`.
std::unique_ptr<HeightSource> layeredDems(std::vector<DemLayer> layers,
                                          const Georeference& reference, int columns, int rows);

}  // namespace eyrie::import
