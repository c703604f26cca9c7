// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <absl/status/status.h>

#include "renderer/lod/view.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/truth/pinhole.h"
#include "renderer/truth/triangle.h"

namespace eyrie::truth {

/// The triangles of which a picture of one terrain is made, in double precision: what a pixel's
/// depth is the depth of. For the few pixels where the depth at the centre does not tell.
class DrawnTerrain {
public:
    /// The cut of `view` at `tauPixels`, from the file; object space is world space.
    /// Errors: those of reading pages.
    static absl::StatusOr<DrawnTerrain> of(const terrain::EytFile& file, const lod::View& view,
                                           double tauPixels);

    struct Shown {
        fabric::Vec3 point;       ///< of a drawn triangle: the one next to the picture point
        double depthAtPoint = 0;  ///< of the triangle's plane at the picture point itself
    };

    /// What lies within `reachPixels` of picture point (x, y) on the screen, and has its plane at
    /// the point nearest to `depth`. Nothing where there is none.
    std::optional<Shown> shownAt(const Pinhole& camera, double x, double y, double depth,
                                 double reachPixels) const;

private:
    std::vector<Triangle> triangles_;
};

}  // namespace eyrie::truth
