// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "renderer/terrain/quadtree.h"
#include "renderer/truth/drawn_terrain.h"

namespace eyrie::truth {

/// How far the outlines of a terrain's data, its holes and its border, are off in a picture: what
/// the comparison column by column cannot see, since only one of the two surfaces is there.
///
/// Both are looked at above posts and halfway between them, and each point that the one has and the
/// other lacks is held against the other's next to it: those within 1.5 times the distance, seen
/// from above, at which there is any. The least displacement in the picture counts.
class OutlineDisplacement {
public:
    /// `source` has the posts of `quadtree`, at `objectFromPosts`; it is referred to.
    OutlineDisplacement(const terrain::Quadtree& quadtree, const fabric::Mat4& objectFromPosts,
                        const TerrainRayCaster& source);

    /// The greatest displacement, in pixels, of what is drawn over nodata and seen, and of what a
    /// picture of the source shows and none is drawn over; `atLeast` when none is greater.
    /// `depth`: the picture's, in metres, rows from the bottom up.
    double farthestSeen(const Pinhole& camera, const DrawnTerrain& drawn,
                        std::span<const float> depth, double atLeast) const;

private:
    struct Candidate {
        double pixels;
        fabric::Vec3 point;
    };
    using Heights = std::vector<float>;  ///< by half posts, row by row; NaN: nothing there

    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    std::pair<double, double> heightsAt(double x, double y) const;
    fabric::Vec3 pointAt(int x, int y, const Heights& heights) const;
    void addMissing(const Pinhole& camera, const Heights& there, const Heights& lacking,
                    double atLeast, std::vector<Candidate>& candidates) const;
    double leastPixels(const Pinhole& camera, const fabric::Vec2& from, int x, int y,
                       const Heights& heights) const;

    fabric::Mat4 objectFromPosts_;
    const TerrainRayCaster& source_;
    int width_;  ///< in half posts
    int height_;
    Heights any_;  ///< the source by some reading of its cells
    Heights all_;  ///< the source where all readings have it
};

}  // namespace eyrie::truth
