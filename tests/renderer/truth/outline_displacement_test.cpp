// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/outline_displacement.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "renderer/import/terrain_import.h"
#include "renderer/lod/view.h"
#include "renderer/terrain/eyt_format.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::truth {
namespace {

using fabric::Camera;
using fabric::Vec3;

constexpr int kPosts = 33;
constexpr double kPostMetres = 16;
constexpr double kMiddle = kPostMetres * (kPosts - 1) / 2;
constexpr int kSide = 300;
/// So far away, through so narrow a view, that a metre on the ground is as many pixels everywhere,
/// within 1.5 %.
constexpr double kDistance = 20'000;
constexpr double kFovYDegrees = 2;
constexpr double kPerspective = 0.015;

/// Posts without data, in columns and in rows from the first up to the last.
struct Hole {
    int firstColumn = 12;
    int lastColumn = 18;
    int firstRow = 12;
    int lastRow = 18;

    Hole movedBy(int columns, int rows) const {
        return {firstColumn + columns, lastColumn + columns, firstRow + rows, lastRow + rows};
    }
    bool has(int i, int j) const {
        return i >= firstColumn && i <= lastColumn && j >= firstRow && j <= lastRow;
    }
};

/// Flat ground with a hole, and a wall across it where `wallColumn` says, if it does.
terrain::HeightGrid ground(const Hole& hole, int wallColumn = -1) {
    terrain::HeightGrid grid{.columns = kPosts,
                             .rows = kPosts,
                             .heights = {},
                             .origin = {0, 0},
                             .perColumn = {kPostMetres, 0},
                             .perRow = {0, kPostMetres}};
    for (int j = 0; j < kPosts; ++j)
        for (int i = 0; i < kPosts; ++i)
            grid.heights.push_back(hole.has(i, j)    ? terrain::kNodata
                                   : i == wallColumn ? 500.0F
                                                     : 0.0F);
    return grid;
}

/// At the terrain's middle from the west, `elevationDegrees` above the ground; north is to the left
/// of the picture, and from straight above east is up.
Camera fromTheWest(double elevationDegrees) {
    const double elevation = elevationDegrees * M_PI / 180;
    Camera camera;
    camera.target = Vec3(kMiddle, kMiddle, 0);
    camera.eye = camera.target + kDistance * Vec3(-std::cos(elevation), 0, std::sin(elevation));
    camera.up = Vec3(std::sin(elevation), 0, std::cos(elevation));
    camera.fovYDegrees = kFovYDegrees;
    return camera;
}

/// On a plane that faces the camera.
double pixelsOf(double metres) {
    return metres * kSide / 2 / std::tan(kFovYDegrees / 2 * M_PI / 180) / kDistance;
}

/// A source, and what is drawn of another one: all posts of it.
class Outlines {
public:
    Outlines(const terrain::HeightGrid& source, const terrain::HeightGrid& drawn)
        : caster_({source.columns, source.rows, source.heights, source.origin, source.perColumn,
                   source.perRow}) {
        const std::string path = folder_.path("drawn.eyt");
        const auto report = import::importTerrain(drawn, {"drawn", "", 0}, path, {});
        EXPECT_TRUE(report.ok()) << report.status();
        file_ = *terrain::EytFile::open(path);
    }

    double farthestSeen(const Camera& camera, double atLeast = 0) const {
        return farthestSeen(camera, Pinhole(camera, kSide, kSide), atLeast, kNothing);
    }

    /// In a part of the picture, in which everything is as far away as `depthMetres` says.
    double farthestSeen(const Camera& camera, const Pinhole& picture, double atLeast,
                        float depthMetres) const {
        constexpr double kAllPosts = 1e-6;
        const auto drawn = DrawnTerrain::of(*file_, lod::View(camera, kSide, kSide), kAllPosts);
        EXPECT_TRUE(drawn.ok()) << drawn.status();
        const std::vector<float> depth(
            static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height()),
            depthMetres);
        const terrain::EytIndex& index = file_->index();
        return OutlineDisplacement(index.quadtree, index.objectFromLattice, caster_)
            .farthestSeen(picture, *drawn, depth, atLeast);
    }

    static constexpr float kNothing = std::numeric_limits<float>::infinity();

private:
    test::TemporaryFolder folder_;
    TerrainRayCaster caster_;
    std::shared_ptr<const terrain::EytFile> file_;
};

/// A hole that is drawn some posts beside where it is.
Outlines moved(int columns, int rows) {
    return {ground({}), ground(Hole().movedBy(columns, rows))};
}

testing::Matcher<double> about(double pixels) {
    return testing::DoubleNear(pixels, pixels * kPerspective);
}

TEST(OutlineDisplacement, IsNoneWhereNothingHasMoved) {
    for (const double elevation : {90.0, 30.0}) {
        EXPECT_EQ(moved(0, 0).farthestSeen(fromTheWest(elevation)), 0) << elevation;
        EXPECT_EQ(moved(0, 0).farthestSeen(fromTheWest(elevation), 0.25), 0.25) << elevation;
    }
}

TEST(OutlineDisplacement, IsHowFarAHoleHasMovedSeenStraightDown) {
    for (const int posts : {1, 2, 3}) {
        SCOPED_TRACE(posts);
        const double expected = pixelsOf(posts * kPostMetres);
        for (const auto& [columns, rows] :
             {std::pair(posts, 0), {-posts, 0}, {0, posts}, {0, -posts}})
            EXPECT_THAT(moved(columns, rows).farthestSeen(fromTheWest(90)), about(expected))
                << columns << ", " << rows;
    }
}

TEST(OutlineDisplacement, IsShorterAslantAlongTheViewAndNotAcrossIt) {
    const Camera aslant = fromTheWest(30);
    const double post = pixelsOf(kPostMetres);
    EXPECT_THAT(moved(3, 0).farthestSeen(aslant), about(3 * post / 2));
    EXPECT_THAT(moved(-3, 0).farthestSeen(aslant), about(3 * post / 2));
    EXPECT_THAT(moved(0, 1).farthestSeen(aslant), about(post));
    EXPECT_THAT(moved(0, 3).farthestSeen(aslant), about(8 * post / 2 / 2))
        << "the ends of the hole, 8 posts long, are nearer";
}

TEST(OutlineDisplacement, IsThatOfWhatIsMissingAsOfWhatIsTooMuch) {
    const Hole smaller{14, 16, 14, 16};  // by two posts on each side
    const double expected = pixelsOf(2 * kPostMetres);
    EXPECT_THAT(Outlines(ground({}), ground(smaller)).farthestSeen(fromTheWest(90)),
                about(expected));
    EXPECT_THAT(Outlines(ground(smaller), ground({})).farthestSeen(fromTheWest(90)),
                about(expected));
}

TEST(OutlineDisplacement, IsNotLessThanWhatWasFoundBefore) {
    const double found = pixelsOf(4 * kPostMetres);
    EXPECT_EQ(moved(3, 0).farthestSeen(fromTheWest(90), found), found);
}

/// Of the columns from 11 to 14, which are drawn over nodata, and of those from 19 to 22, of which
/// nothing is drawn, a part of the picture has some.
TEST(OutlineDisplacement, CountsWhatIsInThePictureAlone) {
    const Outlines outlines = moved(3, 0);
    const Camera camera = fromTheWest(90);
    const auto between = [&](double firstColumn, double lastColumn) {
        const auto row = [&](double column) {
            return static_cast<int>(
                std::lround(kSide / 2.0 + pixelsOf(column * kPostMetres - kMiddle)));
        };
        const int first = row(firstColumn);
        const Pinhole part = Pinhole(camera, kSide, kSide)
                                 .sampled({0, first}, {1, 1}, kSide, row(lastColumn) - first);
        return outlines.farthestSeen(camera, part, 0, Outlines::kNothing);
    };
    EXPECT_EQ(between(5, 10.75), 0) << "the outline is where it was to be";
    EXPECT_THAT(between(5, 12.75), about(pixelsOf(1.5 * kPostMetres)));
    EXPECT_THAT(between(12.75, 17), about(pixelsOf(3 * kPostMetres)))
        << "from what is beside the picture";
    EXPECT_EQ(between(15.25, 17.75), 0) << "nodata in both";
    EXPECT_THAT(between(20.25, 25), about(pixelsOf(1.5 * kPostMetres)));
}

/// A wall of 500 m hides, from 30 degrees above the ground, 866 m behind it.
TEST(OutlineDisplacement, LeavesOutWhatTheSourceHides) {
    const Outlines behindAWall(ground({}, 8), ground(Hole().movedBy(3, 0), 8));
    EXPECT_EQ(behindAWall.farthestSeen(fromTheWest(30)), 0);
    EXPECT_THAT(behindAWall.farthestSeen(fromTheWest(90)), about(pixelsOf(3 * kPostMetres)));
}

/// Of what is missing a picture says nothing.
TEST(OutlineDisplacement, LeavesOutWhatThePictureHidesOfWhatIsTooMuch) {
    const Camera camera = fromTheWest(90);
    const Pinhole picture(camera, kSide, kSide);
    const Hole smaller{14, 16, 14, 16};
    const Outlines tooMuch(ground({}), ground(smaller));
    const Outlines missing(ground(smaller), ground({}));
    const auto before = static_cast<float>(0.9 * kDistance);
    const auto there = static_cast<float>(kDistance);
    const double expected = pixelsOf(2 * kPostMetres);
    EXPECT_EQ(tooMuch.farthestSeen(camera, picture, 0, before), 0);
    EXPECT_THAT(tooMuch.farthestSeen(camera, picture, 0, there), about(expected));
    EXPECT_THAT(missing.farthestSeen(camera, picture, 0, before), about(expected));
}

}  // namespace
}  // namespace eyrie::truth
