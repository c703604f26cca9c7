// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/node_shares.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/draw/node_work.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "tests/support/ladders.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::draw {
namespace {

const NodeShares::NodeTest kNone = [](std::uint32_t) { return false; };

/// A ball in three levels, and ladders that are points from afar.
class NodeSharesOf : public testing::TestWithParam<bool> {
protected:
    void SetUp() override {
        const bool isBall = GetParam();
        const auto report = import::importMesh(
            isBall ? import::synthesizeMesh(150000, 4) : test::ladders(300, 80), path());
        ASSERT_TRUE(report.ok()) << report.status();
        auto opened = mesh::EymFile::open(path());
        ASSERT_TRUE(opened.ok()) << opened.status();
        file_.emplace(*std::move(opened));
    }

    std::string path() const { return folder_.path("m.eym"); }

    /// From anywhere, towards anything of it.
    lod::ObjectView randomView() {
        const fabric::Box box = file_->bounds();
        const double across = glm::length(box.size());
        std::normal_distribution<double> any;
        const auto direction = [&] {
            return glm::normalize(fabric::Vec3(any(random_), any(random_), any(random_)));
        };
        fabric::Camera camera;
        camera.target = box.centre() + 0.3 * across * direction();
        camera.eye = box.centre() + across * std::exp(any(random_)) * direction();
        camera.up = direction();
        return {lod::View(camera, 640, 360), fabric::Mat4(1.0)};
    }

    /// Ascending, from 0 to 1.
    std::vector<double> randomCuts() {
        std::vector<double> cuts{0, 1};
        for (int i = std::uniform_int_distribution(0, 5)(random_); i > 0; --i)
            cuts.push_back(std::uniform_real_distribution(0.0, 1.0)(random_));
        std::ranges::sort(cuts);
        return cuts;
    }

    std::uint64_t costOf(const CutNode& node) const {
        return node.points > 0 ? node.points : file_->nodes()[node.node].indexCount / 3;
    }

    NodeShares sharesOf(const MeshCut& wanted, const CutRequest& request,
                        const NodeShares::NodeTest& hasBlended = kNone) const {
        return {*file_, wanted.wanted, workOf(*file_, request.view, wanted.wanted), request,
                hasBlended};
    }

    static CutRequest requestOf(const lod::ObjectView& view, double begin, double end) {
        return {.view = view, .channel = view.view().frustum, .range = {begin, end}};
    }

    MeshCut wantedOf(const lod::ObjectView& view, double tauPixels) const {
        return cutOf(*file_, view, tauPixels, [](std::uint32_t) { return true; });
    }

    /// That all of a wanted node that is in view is drawn; by how many others, each as a whole.
    std::size_t countStandIns(const CutNode& wanted, const MeshCut& cut, const NodeShares& shares,
                              const CutRequest& request) const {
        const mesh::Node& node = file_->nodes()[wanted.node];
        std::uint64_t drawnTo = node.triangleBegin;  // of the source's
        std::size_t standIns = 0;
        const auto mayEndAt = [&](std::uint64_t next) {
            for (std::uint32_t i = 0; i < file_->nodes().size(); ++i) {
                const mesh::Node& leaf = file_->nodes()[i];
                const bool isBetween = leaf.triangleBegin >= drawnTo && leaf.triangleEnd <= next;
                EXPECT_FALSE(leaf.isLeaf() && isBetween &&
                             request.view.isVisible(file_->bounds(i)));
            }
        };
        for (const CutNode& drawn : cut.drawn) {
            const mesh::Node& other = file_->nodes()[drawn.node];
            if (other.triangleEnd <= node.triangleBegin || other.triangleBegin >= node.triangleEnd)
                continue;
            mayEndAt(other.triangleBegin);
            drawnTo = other.triangleEnd;
            const NodePart part = shares.partOf(drawn);
            EXPECT_TRUE(request.range.contains(part.rangePosition));
            if (drawn.node == wanted.node)
                continue;
            ++standIns;
            EXPECT_EQ(part.firstTriangle, 0U);
            EXPECT_EQ(part.triangles, drawn.points > 0 ? 0U : other.indexCount / 3);
        }
        mayEndAt(node.triangleEnd);
        return standIns;
    }

    test::TemporaryFolder folder_;
    std::optional<mesh::EymFile> file_;
    std::mt19937 random_{7};
};

TEST_P(NodeSharesOf, AViewAreDrawnOnceInTheOrderOfTheWhole) {
    for (int i = 0; i < 300; ++i) {
        const lod::ObjectView view = randomView();
        const MeshCut wanted = wantedOf(view, std::exp2(i % 9 - 3));
        const std::vector<double> cuts = randomCuts();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> drawn;  // node, triangle
        std::vector<std::uint32_t> points;
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            const CutRequest request = requestOf(view, cuts[k], cuts[k + 1]);
            const NodeShares shares = sharesOf(wanted, request);
            MeshCut mine = wanted;
            shares.keepNeeded(mine);
            double last = 0;
            for (const CutNode& node : mine.drawn) {
                const NodePart part = shares.partOf(node);
                ASSERT_GE(part.rangePosition, last);
                ASSERT_TRUE(request.range.contains(part.rangePosition));
                last = part.rangePosition;
                for (std::uint32_t t = 0; t < part.triangles; ++t)
                    drawn.emplace_back(node.node, part.firstTriangle + t);
                if (node.points > 0)
                    points.push_back(node.node);
            }
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
        std::vector<std::uint32_t> allPoints;
        for (const CutNode& node : wanted.wanted) {
            if (node.points > 0)
                allPoints.push_back(node.node);
            for (std::uint32_t t = 0; node.points == 0 && t < costOf(node); ++t)
                all.emplace_back(node.node, t);
        }
        ASSERT_EQ(drawn, all);
        ASSERT_EQ(points, allPoints);
    }
}

TEST_P(NodeSharesOf, AViewAreAsLargeAsTheirRanges) {
    for (int i = 0; i < 100; ++i) {
        const lod::ObjectView view = randomView();
        const MeshCut wanted = wantedOf(view, 0.5);
        const std::vector<double> work = workOf(*file_, view, wanted.wanted);
        const double all = std::accumulate(work.begin(), work.end(), 0.0);
        const double most = work.empty() ? 0 : std::ranges::max(work);
        const CutRequest request = requestOf(view, 0.25, 0.75);
        const NodeShares shares = sharesOf(wanted, request);
        double mine = 0;
        for (std::size_t k = 0; k < work.size(); ++k) {
            const CutNode& node = wanted.wanted[k];
            if (!shares.isNeeded(node.node))
                continue;
            const double part = node.points > 0
                                    ? 1
                                    : static_cast<double>(shares.partOf(node).triangles) /
                                          static_cast<double>(costOf(node));
            mine += part * work[k];
        }
        // Points are not cut; a triangle more or less at either end.
        EXPECT_NEAR(mine, 0.5 * all, GetParam() ? 2 * kWorkOfSeen : 2 * most);
    }
}

/// Whatever is there of each channel's nodes: what it cannot draw as it should it draws otherwise,
/// all of what falls to it.
TEST_P(NodeSharesOf, AViewLeaveNoGapsWhereNodesAreMissing) {
    std::size_t stoodIn = 0;
    for (int i = 0; i < 300; ++i) {
        const lod::ObjectView view = randomView();
        const MeshCut wanted = wantedOf(view, std::exp2(i % 9 - 3));
        const double drawnTau = std::exp2(i % 9 - 3 + i % 3);  // one may have less memory
        const std::vector<double> cuts = randomCuts();
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            const CutRequest request = requestOf(view, cuts[k], cuts[k + 1]);
            const NodeShares shares = sharesOf(wanted, request);
            std::map<std::uint32_t, bool> isThere{{0, true}};
            MeshCut mine = cutOf(*file_, view, drawnTau, [&](std::uint32_t node) {
                return !shares.isNeeded(node) ||
                       isThere.try_emplace(node, random_() % 2 == 0).first->second;
            });
            if (!mine.isWhole)
                continue;  // and says so
            shares.keepNeeded(mine);
            for (const CutNode& one : wanted.wanted)
                if (shares.isNeeded(one.node))
                    stoodIn += countStandIns(one, mine, shares, request);
        }
    }
    EXPECT_GT(stoodIn, 100U);
}

TEST_P(NodeSharesOf, AViewWithBlendedNodesFallToAllOfThem) {
    const lod::ObjectView view = randomView();
    const MeshCut wanted = wantedOf(view, 0.5);
    const NodeShares::NodeTest all = [](std::uint32_t) { return true; };
    for (const double begin : {0.0, 0.25, 0.5, 0.75}) {
        const CutRequest request = requestOf(view, begin, begin + 0.25);
        const NodeShares shares = sharesOf(wanted, request, all);
        MeshCut mine = wanted;
        shares.keepNeeded(mine);
        ASSERT_EQ(mine.drawn.size(), wanted.drawn.size());
        const NodeShares whole = sharesOf(wanted, requestOf(view, 0, 1), all);
        for (const CutNode& node : mine.drawn) {
            EXPECT_EQ(shares.partOf(node).rangePosition, whole.partOf(node).rangePosition);
            EXPECT_EQ(shares.partOf(node).firstTriangle, 0U);
        }
    }
}

TEST_P(NodeSharesOf, AViewCountsWhatIsSeenForMoreThanWhatIsHidden) {
    const fabric::Box box = file_->bounds();
    const double radius = 0.5 * glm::length(box.size());
    fabric::Camera camera;
    camera.target = box.centre();
    camera.eye = box.centre() + fabric::Vec3(4 * radius, 0, 0);
    camera.up = {0, 0, 1};
    const lod::ObjectView view(lod::View(camera, 640, 360), fabric::Mat4(1.0));
    const MeshCut wanted = wantedOf(view, 0.1);
    const std::vector<double> work = workOf(*file_, view, wanted.wanted);
    ASSERT_EQ(work.size(), wanted.wanted.size());
    std::size_t front = 0;
    std::size_t back = 0;
    for (std::size_t i = 0; i < work.size(); ++i) {
        const double perTriangle = work[i] / static_cast<double>(costOf(wanted.wanted[i]));
        EXPECT_GE(perTriangle, 1);
        EXPECT_LE(perTriangle, kWorkOfSeen);
        const fabric::Box bounds = file_->bounds(wanted.wanted[i].node);
        const double towards = (bounds.centre() - box.centre()).x / radius;
        if (!GetParam() || std::abs(towards) < 0.3)
            continue;
        ++(towards > 0 ? front : back);
        if (towards > 0)
            EXPECT_EQ(perTriangle, kWorkOfSeen);
        else
            EXPECT_LT(perTriangle, 2.5);
    }
    EXPECT_TRUE(!GetParam() || (front > 0 && back > 0));
}

INSTANTIATE_TEST_SUITE_P(, NodeSharesOf, testing::Values(true, false),
                         [](const auto& one) { return one.param ? "ABall" : "Ladders"; });

}  // namespace
}  // namespace eyrie::draw
