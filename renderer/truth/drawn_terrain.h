// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <absl/status/status.h>

#include "renderer/lod/view.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/truth/pinhole.h"
#include "renderer/truth/terrain_ray_caster.h"
#include "renderer/truth/triangle.h"

namespace eyrie::truth {

/// The triangles of which a picture of one terrain is made, in double precision: what a pixel's
/// depth is the depth of. For the few pixels where the depth at the centre does not tell.
class DrawnTerrain {
public:
    /// The cut of `view` at `tauPixels`, from the file. Errors: those of reading pages.
    static absl::StatusOr<DrawnTerrain> of(const terrain::EytFile& file, const lod::View& view,
                                           double tauPixels,
                                           const fabric::Mat4& worldFromObject = fabric::Mat4(1.0));

    /// In world space.
    std::span<const Triangle> triangles() const { return triangles_; }

    /// The farthest, in pixels, that a drawn point is from the source's point of its column, where
    /// that is seen in a picture of the source; `atLeast` when none is farther. Looks at the posts
    /// and halfway between them, since where they are denser than pixels, pixels' centres miss the
    /// worst of them. Where the source can be read in several ways, the nearest counts, and what
    /// all of them show.
    double farthestSeen(const Pinhole& camera, const TerrainRayCaster& source,
                        double atLeast) const;

    /// Heights above posts and halfway between them, row by row; NaN where nothing is drawn.
    std::vector<float> heightsAtHalfPosts(int width, int height) const;

private:
    std::vector<Triangle> triangles_;
    fabric::Mat4 postsFromWorld_{1.0};
};

}  // namespace eyrie::truth
