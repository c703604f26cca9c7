// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/height_source.h"
#include "renderer/terrain/tiled_raster.h"

/// Posts with data that no ground is at: of none of the four cells around one have three posts
/// data, so nothing is there however cells are read. Soundings, or a line one post wide. They count
/// as nodata: between those that are near each other coarse levels would draw a sheet.
namespace eyrie::import {

/// Those on the border of `window`, whose heights `posts` are: by place in it. Posts beyond the
/// border are read where they alone can tell. Errors: the source's.
absl::StatusOr<std::vector<std::size_t>> lonePostsOnBorder(HeightSource& source,
                                                           const terrain::PostRect& window,
                                                           const std::vector<float>& posts);

/// Makes nodata of them, and of those that are not on the border.
void dropLonePosts(const terrain::PostRect& window, const std::vector<std::size_t>& onBorder,
                   std::vector<float>& posts);

}  // namespace eyrie::import
