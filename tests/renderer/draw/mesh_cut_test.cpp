// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "tests/support/ladders.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::draw {
namespace {

using NodeTest = std::function<bool(std::uint32_t)>;

class MeshCutOfPoints : public testing::Test {
protected:
    void SetUp() override {
        const auto report = import::importMesh(test::ladders(300, 80), folder_.path("m.eym"));
        ASSERT_TRUE(report.ok()) << report.status();
        auto opened = mesh::EymFile::open(folder_.path("m.eym"));
        ASSERT_TRUE(opened.ok()) << opened.status();
        file_.emplace(*std::move(opened));
        ASSERT_TRUE(file_->nodes()[0].isOfPoints());
    }

    /// From above, so that the whole is about so many pixels large.
    lod::ObjectView viewOf(double pixels) const {
        fabric::Camera camera;
        camera.target = file_->bounds().centre();
        camera.up = {0, 1, 0};
        camera.fovYDegrees = 45;
        const double metresAPixel = glm::length(file_->bounds().size()) / pixels;
        camera.eye =
            camera.target + fabric::Vec3(0, 0, metresAPixel * 720 / 2 / std::tan(M_PI / 8));
        return {lod::View(camera, 1280, 720), fabric::Mat4(1.0)};
    }

    /// That each leaf has exactly one drawn node at or above it.
    void checkWhole(const MeshCut& cut) const {
        std::uint64_t at = 0;
        for (const CutNode& one : cut.drawn) {
            const mesh::Node& node = file_->nodes()[one.node];
            EXPECT_EQ(node.triangleBegin, at);
            at = node.triangleEnd;
        }
        EXPECT_EQ(at, file_->triangleCount());
        EXPECT_TRUE(cut.isWhole);
    }

    test::TemporaryFolder folder_;
    std::optional<mesh::EymFile> file_;
};

const NodeTest kAllThere = [](std::uint32_t) { return true; };

TEST_F(MeshCutOfPoints, DrawsPointsOnlyWhereTheyFillTheirPixels) {
    std::set<std::uint32_t> counts;
    for (const double tau : {0.1, 0.5, 1.0, 8.0})
        for (double pixels = 0.5; pixels < 700; pixels *= 1.2) {
            const lod::ObjectView view = viewOf(pixels);
            const MeshCut cut = cutOf(*file_, view, tau, kAllThere);
            checkWhole(cut);
            for (const CutNode& one : cut.drawn) {
                const auto ranges = file_->pointRanges(one.node);
                EXPECT_EQ(one.points > 0, !ranges.empty());
                if (ranges.empty())
                    continue;
                const auto range = std::ranges::find(ranges, one.points, &mesh::PointRange::points);
                ASSERT_NE(range, ranges.end());
                const double off =
                    view.screenSpaceErrorPixels(range->errorMetres, file_->bounds(one.node));
                EXPECT_EQ(one.pointPixels, off + kPointRounding);
                EXPECT_LE(one.pointPixels, kMostPointPixels);
                // A pixel's point is so far from its middle, and the point from the source.
                EXPECT_EQ(one.errorPixels, 2 * off + kPointRounding);
                EXPECT_LE(one.errorPixels, tau);
                counts.insert(one.points);
            }
        }
    EXPECT_GE(counts.size(), 7U);
}

TEST_F(MeshCutOfPoints, TakesFewerPointsTheFartherItIs) {
    std::uint64_t before = std::numeric_limits<std::uint64_t>::max();
    for (const double pixels : {15.0, 3.0, 1.0, 0.4}) {
        const MeshCut cut = cutOf(*file_, viewOf(pixels), 1, kAllThere);
        ASSERT_EQ(cut.drawn.size(), 1U);
        EXPECT_LT(cut.drawn[0].points, before);
        before = cut.drawn[0].points;
    }
    EXPECT_LT(before, 1000U);
    // Nearby it is drawn by its leaves.
    for (const CutNode& one : cutOf(*file_, viewOf(4000), 1, kAllThere).drawn)
        EXPECT_TRUE(file_->nodes()[one.node].isLeaf());
}

TEST_F(MeshCutOfPoints, MayBeLeftOut) {
    const MeshCut cut = cutOf(*file_, viewOf(8), 1, kAllThere, false);
    checkWhole(cut);
    EXPECT_TRUE(cut.above.empty() && cut.between.empty());
    for (const CutNode& one : cut.drawn) EXPECT_TRUE(file_->nodes()[one.node].isLeaf());
    const NodeTest noLeaf = [this](std::uint32_t node) { return !file_->nodes()[node].isLeaf(); };
    EXPECT_FALSE(cutOf(*file_, viewOf(8), 1, noLeaf, false).isWhole);
}

TEST_F(MeshCutOfPoints, StandInWhereTheyAreNotFarApartAndHaveStandIns) {
    const NodeTest noLeaf = [this](std::uint32_t node) { return !file_->nodes()[node].isLeaf(); };
    const lod::ObjectView near = viewOf(400);
    const MeshCut coarse = cutOf(*file_, near, 1, noLeaf);
    checkWhole(coarse);
    ASSERT_FALSE(coarse.drawn.empty());
    for (const CutNode& one : coarse.drawn) {
        EXPECT_EQ(one.points, file_->nodes()[one.node].vertexCount);
        EXPECT_EQ(one.errorPixels,
                  2 * near.screenSpaceErrorPixels(file_->nodes()[one.node].errorMetres,
                                                  file_->bounds(one.node)) +
                      kPointRounding);
    }
    EXPECT_GT(coarse.errorPixels(), 1);
    EXPECT_LE(coarse.errorPixels(), 2 * kMostStandInPixels);
    EXPECT_FALSE(coarse.between.empty() && coarse.above.empty());
    const MeshCut gaps = cutOf(*file_, viewOf(40000), 1, noLeaf);
    EXPECT_FALSE(gaps.isWhole);
    EXPECT_TRUE(std::isinf(gaps.errorPixels()));
    // The root's that are not there: finer points are, or leaves.
    for (const int missingLevels : {1, 2, 100}) {
        const NodeTest isThere = [&](std::uint32_t node) {
            return file_->nodes()[node].isLeaf() ||
                   node >= static_cast<std::uint32_t>(missingLevels);
        };
        const MeshCut cut = cutOf(*file_, viewOf(8), 1, isThere);
        checkWhole(cut);
        ASSERT_EQ(cut.wanted.size(), 1U);
        EXPECT_EQ(cut.wanted[0].node, 0U);
        EXPECT_GT(cut.drawn.size(), 1U);
        EXPECT_LE(cut.errorPixels(), 2 * kMostPointPixels);
    }
}

/// A plane of noise, whose levels are off by nothing but their colours.
TEST(MeshCutOfColours, IsRefinedUntilTheyComeFromWithinTau) {
    import::TriangleMesh mesh;
    constexpr std::uint32_t kSide = 256;
    std::mt19937 random(4);
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            mesh.positions.emplace_back(x, y, 0);
            mesh.colours.push_back({static_cast<std::uint8_t>(random() % 256), 9, 9, 255});
            const std::uint32_t at = y * kSide + x;
            if (x + 1 < kSide && y + 1 < kSide)
                for (const mesh::Triangle& triangle :
                     {mesh::Triangle{at, at + 1, at + kSide + 1}, {at, at + kSide + 1, at + kSide}})
                    mesh.triangles.push_back(triangle);
        }
    const test::TemporaryFolder folder;
    ASSERT_TRUE(import::importMesh(std::move(mesh), folder.path("m.eym")).ok());
    const auto file = mesh::EymFile::open(folder.path("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    fabric::Camera camera;
    camera.target = file->bounds().centre();
    camera.up = {0, 1, 0};
    std::set<std::size_t> sizes;
    for (const double away : {300.0, 3e3, 3e4, 3e5}) {
        camera.eye = camera.target + fabric::Vec3(0, 0, away);
        const lod::ObjectView view(lod::View(camera, 1280, 720), fabric::Mat4(1.0));
        const MeshCut cut = cutOf(*file, view, 1, kAllThere);
        sizes.insert(cut.drawn.size());
        for (const CutNode& one : cut.drawn) {
            const mesh::Node& node = file->nodes()[one.node];
            EXPECT_LE(one.errorPixels, 1);
            EXPECT_GE(one.errorPixels, view.screenSpaceErrorPixels(node.colourReachMetres(),
                                                                   file->bounds(one.node)));
            EXPECT_TRUE(node.isLeaf() || node.colourReachMetres() > node.errorMetres);
        }
    }
    EXPECT_GE(sizes.size(), 3U);
    EXPECT_EQ(*sizes.begin(), 1U);
}

}  // namespace
}  // namespace eyrie::draw
