// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/prefetch.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "renderer/draw/view_turns.h"

namespace eyrie::draw {
namespace {

using fabric::Vec3;
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr int kSide = 400;
constexpr double kTau = 1;

/// A row of 1024 m along x that is halved down to `levels`. The pieces of a level of size s are off
/// by `errorShare` * s.
struct Row {
    /// Heap order from 1: what lies below n is 2n and 2n + 1.
    using Node = std::uint32_t;

    int levels = 11;
    double errorShare = 0.01;

    static int depth(Node node) { return node == 1 ? 0 : 1 + depth(node / 2); }
    double size(Node node) const { return 1024.0 / (1 << depth(node)); }

    Node root() const { return 1; }
    fabric::Box bounds(Node node) const {
        const double from = size(node) * (node - (1U << depth(node)));
        return {{from, -1, -1}, {from + size(node), 1, 1}};
    }
    double errorMetres(Node node) const { return errorShare * size(node); }
    template <typename Visit>
    void forEachChild(Node node, const Visit& visit) const {
        for (const Node child : {2 * node, 2 * node + 1})
            if (depth(child) < levels)
                visit(child);
    }
};

lod::View viewAt(const Vec3& eye, const Vec3& towards = {1, 0, 0}) {
    fabric::Camera camera;
    camera.eye = eye;
    camera.target = eye + towards;
    return {camera, kSide, kSide};
}

/// Of a camera that stands still.
std::vector<Row::Node> aroundEye(const Row& row, const lod::View& view) {
    Prefetch prefetch;
    prefetch.follow(view, fabric::Mat4(1), {});
    return prefetch.nodes(row, kTau, milliseconds(100));
}

TEST(Prefetch, IsWhatWouldBeDrawnAroundTheEyeInWhateverDirection) {
    const Row row;
    const lod::View view = viewAt({300, 0, 0}, {0, 1, 0});
    const std::vector<Row::Node> nodes = aroundEye(row, view);
    const std::set<Row::Node> found(nodes.begin(), nodes.end());
    EXPECT_EQ(found.size(), nodes.size());
    EXPECT_GT(found.size(), 30U);
    EXPECT_LT(found.size(), 1U << row.levels);
    for (Row::Node node = 2; node < 1U << row.levels; ++node) {
        // Drawn where its parent is off by more than tau.
        const Row::Node parent = node / 2;
        const double off = row.errorMetres(parent) * view.greatestFocalPixels() / kTau;
        const bool isDrawn =
            found.contains(parent) && off > distanceTo(row.bounds(parent), view.eye);
        EXPECT_EQ(found.contains(node), isDrawn) << node;
    }
}

TEST(Prefetch, CoarseNodesComeFirstAndThenWhatLiesAhead) {
    const Row row;
    for (const double towards : {1.0, -1.0}) {
        const std::vector<Row::Node> nodes = aroundEye(row, viewAt({500, 0, 0}, {towards, 0, 0}));
        ASSERT_EQ(nodes.front(), row.root());
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            const int deeper = Row::depth(nodes[i]) - Row::depth(nodes[i - 1]);
            EXPECT_GE(deeper, 0);
            const bool isAhead = (row.bounds(nodes[i]).centre().x - 500) * towards > 0;
            const bool wasAhead = (row.bounds(nodes[i - 1]).centre().x - 500) * towards > 0;
            EXPECT_TRUE(deeper > 0 || wasAhead || !isAhead) << i;
        }
    }
}

/// Of the finest pieces, 1 m each, those around where the camera will be.
TEST(Prefetch, LooksAheadAsFarAsLoadingTakes) {
    const Row row;
    const auto start = Prefetch::Clock::time_point(std::chrono::hours(1));
    const auto finestAt = [&](Prefetch::Clock::duration step, duration<double> latency) {
        Prefetch prefetch;
        prefetch.follow(viewAt({200, 0, 0}), fabric::Mat4(1), start);
        prefetch.follow(viewAt({210, 0, 0}), fabric::Mat4(1), start + step);
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (const Row::Node node : prefetch.nodes(row, kTau, latency))
            if (Row::depth(node) == row.levels - 1) {
                least = std::min(least, row.bounds(node).min.x);
                most = std::max(most, row.bounds(node).max.x);
            }
        return 0.5 * (least + most);
    };
    EXPECT_NEAR(finestAt(milliseconds(100), milliseconds(0)), 210, 3);
    EXPECT_NEAR(finestAt(milliseconds(100), milliseconds(500)), 260, 3);        // 100 m a second
    EXPECT_NEAR(finestAt(milliseconds(100), std::chrono::hours(1)), 310, 3);    // a second at most
    EXPECT_NEAR(finestAt(std::chrono::seconds(5), milliseconds(500)), 210, 3);  // it had rested
}

/// Not between them, as if a camera flew to and fro.
TEST(Prefetch, OfViewsByTurnsIsAroundEachOfThem) {
    const Row row;
    ViewTurns turns;
    PerView<Prefetch> prefetches;
    auto now = Prefetch::Clock::time_point(std::chrono::hours(1));
    for (int round = 0; round < 6; ++round)
        for (const double x : {200.0, 800.0}) {
            const lod::View view = viewAt({x, 0, 0});
            const ViewTurn turn =
                turns.next({view, {}, {0, 0, kSide, kSide}}, fabric::Completeness::Interactive);
            Prefetch& prefetch = prefetches.of(turn);
            prefetch.follow(view, fabric::Mat4(1), now += milliseconds(10));
            if (round > 2) {
                EXPECT_EQ(prefetch.nodes(row, kTau, milliseconds(100)), aroundEye(row, view));
            }
        }
}

TEST(Prefetch, IsOfTheObjectWhereItIsPlaced) {
    const Row row;
    fabric::Mat4 moved = glm::translate(fabric::Mat4(1), Vec3(5000, -70, 3));
    moved = glm::scale(moved, Vec3(10));
    Prefetch placed;
    placed.follow(viewAt(Vec3(moved * fabric::Vec4(300, 0, 0, 1))), moved, {});
    EXPECT_EQ(placed.nodes(row, kTau, milliseconds(0)), aroundEye(row, viewAt({300, 0, 0})));
}

/// What cannot be drawn itself is not the end of the way down; the limit is.
TEST(Prefetch, EndsAtItsLimitWithTheFinestLeftOut) {
    const Row row{20, std::numeric_limits<double>::infinity()};
    const std::vector<Row::Node> nodes = aroundEye(row, viewAt({500, 0, 0}));
    EXPECT_EQ(nodes.size(), Prefetch::kMostNodes);
    EXPECT_EQ(std::set<Row::Node>(nodes.begin(), nodes.end()).size(), nodes.size());
    EXPECT_EQ(Row::depth(nodes.back()), 12);  // 2^12 - 1 nodes lie above
}

}  // namespace
}  // namespace eyrie::draw
