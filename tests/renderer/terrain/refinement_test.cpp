// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/refinement.h"

#include <set>

#include <gtest/gtest.h>
#include <malloc.h>

#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::terrain {
namespace {

using test::Random;

/// A restricted refinement of what lies around some random spots.
Refinement randomRefinement(const Quadtree& quadtree, Random& random) {
    Refinement refinement(quadtree);
    for (int spot = random.integer(1, 8); spot > 0; --spot) {
        const std::int32_t x = random.integer(0, quadtree.tilesX(0) - 1);
        const std::int32_t y = random.integer(0, quadtree.tilesY(0) - 1);
        for (int level = random.integer(1, quadtree.levels() - 1); level < quadtree.levels();
             ++level)
            refinement.split({level, x >> level, y >> level});
    }
    refinement.restrict();
    return refinement;
}

std::vector<TileId> leaves(const Refinement& refinement) {
    std::vector<TileId> result;
    refinement.forEachLeaf([&](const TileId& tile) { result.push_back(tile); });
    return result;
}

/// The leaf that covers a tile of level 0; fails when it is not exactly one.
class Coverage {
public:
    Coverage(const Quadtree& quadtree, const std::vector<TileId>& tiles)
        : quadtree_(quadtree),
          levels_(static_cast<std::size_t>(quadtree.tilesX(0) * quadtree.tilesY(0)), -1) {
        for (const TileId& tile : tiles) {
            const std::int32_t scale = 1 << tile.level;
            for (std::int32_t y = tile.y * scale; y < (tile.y + 1) * scale; ++y)
                for (std::int32_t x = tile.x * scale; x < (tile.x + 1) * scale; ++x)
                    if (quadtree.contains({0, x, y})) {
                        EXPECT_EQ(at(x, y), -1) << "covered twice: " << x << ", " << y;
                        at(x, y) = tile.level;
                    }
        }
    }
    int& at(std::int32_t x, std::int32_t y) {
        return levels_[static_cast<std::size_t>(y * quadtree_.tilesX(0) + x)];
    }
    /// Everything is covered, and by levels that differ by one at most across each border.
    void expectRestricted() {
        for (std::int32_t y = 0; y < quadtree_.tilesY(0); ++y)
            for (std::int32_t x = 0; x < quadtree_.tilesX(0); ++x) {
                EXPECT_GE(at(x, y), 0) << "a hole: " << x << ", " << y;
                if (x > 0) {
                    EXPECT_LE(std::abs(at(x, y) - at(x - 1, y)), 1);
                }
                if (y > 0) {
                    EXPECT_LE(std::abs(at(x, y) - at(x, y - 1)), 1);
                }
            }
    }

private:
    const Quadtree& quadtree_;
    std::vector<int> levels_;
};

/// A view makes and copies several. Sanitizers' heaps tell nothing, and pass.
TEST(Refinement, OfTheLargestGridTakesLessThanAMegabyte) {
    const auto bytes = [] {
        const struct mallinfo2 heap = mallinfo2();
        return heap.uordblks + heap.hblkhd;
    };
    const Quadtree quadtree(1U << 17, 1U << 17);
    const std::size_t before = bytes();
    const Refinement refinement(quadtree);
    EXPECT_LT(bytes() - before, std::size_t{1} << 20);
    EXPECT_FALSE(refinement.isSplit(quadtree.top()));
}

class CoarseningLaws : public testing::TestWithParam<std::uint64_t> {
protected:
    CoarseningLaws()
        : random_(GetParam()),
          quadtree_(static_cast<std::uint32_t>(random_.integer(40, 2000)),
                    static_cast<std::uint32_t>(random_.integer(40, 2000))),
          wanted_(randomRefinement(quadtree_, random_)),
          isResident_(quadtree_.tileCount()) {
        const double share = random_.unit();
        for (auto& flag : isResident_) flag = random_.unit() < share ? 1 : 0;
        isResident_[quadtree_.tileIndex(quadtree_.top())] = 1;
    }

    bool isResident(const TileId& tile) const {
        return isResident_[quadtree_.tileIndex(tile)] != 0;
    }
    Refinement coarsened() const {
        Refinement drawn = wanted_;
        drawn.coarsen([&](const TileId& tile) { return isResident(tile); });
        return drawn;
    }
    /// Brings to memory all that `share` of the tiles need, so that little is missing.
    void addResidents(double share) {
        for (auto& flag : isResident_)
            if (random_.unit() < share)
                flag = 1;
    }

    Random random_;
    Quadtree quadtree_;
    Refinement wanted_;
    std::vector<std::uint8_t> isResident_;
};

TEST_P(CoarseningLaws, CoversTheTerrainOnceWithNeighboursOneLevelApart) {
    for (const double share : {0.0, 0.5, 0.9, 0.97}) {
        addResidents(share);
        Coverage(quadtree_, leaves(coarsened())).expectRestricted();
    }
}

TEST_P(CoarseningLaws, DrawsResidentTilesOnlyAndNoneFinerThanWanted) {
    addResidents(0.9);
    const Refinement drawn = coarsened();
    for (const TileId& tile : leaves(drawn)) {
        EXPECT_TRUE(isResident(tile)) << tile.level << ": " << tile.x << ", " << tile.y;
        EXPECT_TRUE(tile == quadtree_.top() || wanted_.isSplit(Quadtree::parent(tile)));
    }
}

TEST_P(CoarseningLaws, ChangesNothingWhenAllIsThere) {
    addResidents(1);
    EXPECT_EQ(leaves(coarsened()), leaves(wanted_));
}

/// By brute force: conditions violated are taken back one at a time, until none is, in an order
/// that differs from coarsen's.
TEST_P(CoarseningLaws, FindsTheLargestSuchCut) {
    addResidents(0.9);
    std::set<std::tuple<int, int, int>> split;
    for (int level = 1; level < quadtree_.levels(); ++level)
        for (std::int32_t y = 0; y < quadtree_.tilesY(level); ++y)
            for (std::int32_t x = 0; x < quadtree_.tilesX(level); ++x)
                if (wanted_.isSplit({level, x, y}))
                    split.insert({level, x, y});
    const auto isSplit = [&](const TileId& tile) {
        return split.contains({tile.level, tile.x, tile.y});
    };
    const auto mayStay = [&](const TileId& tile) {
        for (int i = 0; i < 4; ++i)
            if (const TileId child = Quadtree::child(tile, i);
                quadtree_.contains(child) && !isSplit(child) && !isResident(child))
                return false;
        if (tile == quadtree_.top())
            return true;
        for (int edge = 0; edge < kEdges; ++edge)
            if (const TileId next = Quadtree::neighbour(tile, edge);
                quadtree_.contains(next) && !isSplit(Quadtree::parent(next)))
                return false;
        return isSplit(Quadtree::parent(tile));
    };
    bool hasChanged = true;
    while (hasChanged)
        hasChanged = std::erase_if(split, [&](const auto& key) {
                         return !mayStay(std::make_from_tuple<TileId>(key));
                     }) > 0;
    const Refinement drawn = coarsened();
    for (int level = 1; level < quadtree_.levels(); ++level)
        for (std::int32_t y = 0; y < quadtree_.tilesY(level); ++y)
            for (std::int32_t x = 0; x < quadtree_.tilesX(level); ++x)
                EXPECT_EQ(drawn.isSplit({level, x, y}), isSplit({level, x, y}));
}

INSTANTIATE_TEST_SUITE_P(RandomResidency, CoarseningLaws, testing::Range<std::uint64_t>(0, 40));

}  // namespace
}  // namespace eyrie::terrain
