// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/piece_points.h"

#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace eyrie::mesh {
namespace {

constexpr std::uint32_t kPieces = 40;
constexpr double kAnywhere = std::numeric_limits<double>::infinity();

/// Clumps, some of them all on one spot, with a few points far away: what a grid over all of them
/// would have in one cell.
std::vector<PiecePoint> clumps(std::mt19937& random) {
    std::uniform_int_distribution<int> near(0, 6);
    std::uniform_int_distribution<int> far(-100'000, 100'000);
    std::uniform_int_distribution<std::uint32_t> pieces(0, kPieces - 1);
    std::vector<PiecePoint> points;
    for (std::uint32_t k = 0; k < 600; ++k) {
        glm::dvec3 position(near(random), near(random), near(random));
        if (k % 100 == 0)
            position = {far(random), far(random), far(random)};
        points.push_back({position, pieces(random), k});
    }
    return points;
}

/// By looking at all of them.
const PiecePoint* nearestOf(const std::vector<PiecePoint>& points, const glm::dvec3& at,
                            std::uint32_t own, double reach, const std::vector<bool>& isThere) {
    const PiecePoint* best = nullptr;
    for (const PiecePoint& point : points)
        if (point.piece != own && isThere[point.piece] &&
            glm::distance(point.position, at) <= reach &&
            (best == nullptr ||
             glm::distance(point.position, at) < glm::distance(best->position, at)))
            best = &point;
    return best;
}

TEST(PiecePoints, FindTheFirstOfTheNearestOfOtherPiecesWhileSomeGo) {
    std::mt19937 random(20261123);
    for (int round = 0; round < 20; ++round) {
        const std::vector<PiecePoint> points = clumps(random);
        PiecePoints pieces(points);
        std::vector<bool> isThere(kPieces, true);
        for (std::uint32_t gone = 0; gone <= kPieces; ++gone) {
            for (std::size_t k = gone; k < points.size(); k += 37) {
                const glm::dvec3 at = points[k].position + glm::dvec3(0.5, 0, 0.25);
                const std::uint32_t own = points[k].piece;
                const double reach = k % 2 == 0 ? 2 : kAnywhere;
                const PiecePoint* expected = nearestOf(points, at, own, reach, isThere);
                const PiecePoint* found = pieces.nearest(at, own, reach);
                ASSERT_EQ(found == nullptr, expected == nullptr) << gone;
                if (found == nullptr)
                    continue;
                ASSERT_EQ(found->triangle, expected->triangle) << gone << " " << k;
            }
            if (gone < kPieces) {
                pieces.remove(gone);
                isThere[gone] = false;
            }
        }
        EXPECT_EQ(pieces.nearest({}, 0, kAnywhere), nullptr);
    }
}

TEST(PiecePoints, FindNothingWhereThereIsNothing) {
    EXPECT_EQ(PiecePoints({}).nearest({}, 0, kAnywhere), nullptr);
    PiecePoints one({{glm::dvec3(1), 3, 5}});
    EXPECT_EQ(one.nearest({}, 3, kAnywhere), nullptr);
    ASSERT_NE(one.nearest({}, 2, kAnywhere), nullptr);
    one.remove(2);
    EXPECT_EQ(one.nearest({}, 2, kAnywhere)->triangle, 5U);
    one.remove(3);
    one.remove(3);
    EXPECT_EQ(one.nearest({}, 2, kAnywhere), nullptr);
}

}  // namespace
}  // namespace eyrie::mesh
