// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/vertex_levels.h"

#include <algorithm>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "renderer/terrain/quadtree.h"
#include "tests/renderer/terrain/grid_model.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::terrain {
namespace {

using test::GridKind;
using test::Random;

/// The definition, vertex by vertex over the whole padded square, every triangle in full.
class Reference {
public:
    Reference(const HeightGrid& grid, SourceSurface& surface, std::vector<double> thresholds)
        : grid_(grid), surface_(surface), thresholds_(std::move(thresholds)) {
        side_ = Quadtree::side(Quadtree(static_cast<std::uint32_t>(grid.columns),
                                        static_cast<std::uint32_t>(grid.rows))
                                   .top()
                                   .level);
        for (std::int32_t s = 1; s < side_; s *= 2)
            for (const bool isCentre : {false, true})
                for (std::int32_t j = 0; j < std::min(grid.rows - 1 + s, side_ + 1); j += s)
                    for (std::int32_t i = 0; i < std::min(grid.columns - 1 + s, side_ + 1); i += s)
                        if (isCentre ? ((i & s) != 0 && (j & s) != 0) : (((i ^ j) & s) != 0))
                            counts_[{i, j}] = countOf(i, j, s, isCentre);
    }

    int at(std::int32_t i, std::int32_t j) const {
        const auto found = counts_.find({i, j});
        return found == counts_.end() ? 0 : found->second;
    }
    /// Of the two triangles that the vertex splits.
    double deviationAt(std::int32_t i, std::int32_t j) const {
        const auto found = deviations_.find({i, j});
        return found == deviations_.end() ? 0 : found->second;
    }

private:
    int countOf(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) {
        own_ = 0;
        const int count = countWithOwn(i, j, s, isCentre);
        deviations_[{i, j}] = own_;
        return count;
    }

    int countWithOwn(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) {
        int count = 0;
        const std::int32_t h = isCentre ? s : s / 2;
        if (isCentre)
            count = std::max({at(i - s, j), at(i + s, j), at(i, j - s), at(i, j + s)});
        else if (h > 0)
            count =
                std::max({at(i - h, j - h), at(i + h, j - h), at(i - h, j + h), at(i + h, j + h)});
        std::int32_t dx = s, dy = 0;
        if (isCentre) {
            dx = (((i - s) ^ (j - s)) & (2 * s)) == 0 ? s : -s;
            dy = s;
        } else if ((i & s) == 0) {
            std::swap(dx, dy);
        }
        // The hypotenuse from (-dx, -dy) to (dx, dy); right angles where it turns by 90 degrees.
        const std::int32_t ax = isCentre ? dx : dy, ay = isCentre ? -dy : -dx;
        return std::max({count, exceededBy({i + ax, j + ay}, {i - dx, j - dy}, {i + dx, j + dy}),
                         exceededBy({i - ax, j - ay}, {i + dx, j + dy}, {i - dx, j - dy})});
    }

    int exceededBy(std::pair<int, int> apex, std::pair<int, int> p, std::pair<int, int> q) {
        if (apex.first < 0 || apex.second < 0 || apex.first > side_ || apex.second > side_)
            return 0;
        Triangle t;
        bool isInside = true;
        bool isPastI = true;
        bool isPastJ = true;
        const std::array<std::pair<int, int>, 3> points{apex, p, q};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [x, y] = points[k];
            isInside = isInside && x < grid_.columns && y < grid_.rows;
            t[k] = {std::min(x, grid_.columns - 1), std::min(y, grid_.rows - 1), 0};
            t[k].z = static_cast<double>(grid_.at(t[k].i, t[k].j));
            isPastI = isPastI && t[k].i == grid_.columns - 1;
            isPastJ = isPastJ && t[k].j == grid_.rows - 1;
        }
        if (isPastI || isPastJ)
            return 0;
        const double deviation = isInside ? surface_.ofAligned(t) : surface_.ofGeneral(t);
        own_ = std::max(own_, deviation);
        return static_cast<int>(std::count_if(thresholds_.begin(), thresholds_.end(),
                                              [&](double limit) { return deviation > limit; }));
    }

    const HeightGrid& grid_;
    SourceSurface& surface_;
    std::vector<double> thresholds_;
    std::int32_t side_ = 0;
    std::map<std::pair<std::int32_t, std::int32_t>, int> counts_;
    std::map<std::pair<std::int32_t, std::int32_t>, double> deviations_;
    double own_ = 0;  ///< greatest of the vertex being counted
};

std::vector<double> thresholdsFor(const HeightGrid& grid) {
    std::vector<double> thresholds;
    const Quadtree quadtree(static_cast<std::uint32_t>(grid.columns),
                            static_cast<std::uint32_t>(grid.rows));
    for (int level = 0; level < quadtree.levels(); ++level)
        thresholds.push_back(level == 0 ? 0.01 : 0.9 * (1 << level));
    return thresholds;
}

void expectTheDefinition(const HeightGrid& grid, const std::string& name) {
    test::GridModel model(grid);
    VertexLevels levels(model.model(), model.scratch());
    levels.setThresholds(thresholdsFor(grid));
    ASSERT_TRUE(levels.measure({}).ok());
    ASSERT_TRUE(levels.join({}).ok());
    ASSERT_TRUE(levels.finish({}).ok());
    Reference expected(grid, model.surface(), thresholdsFor(grid));
    for (int layer = 0; layer < 6; ++layer) {
        const PostRect all{0, 0, ((grid.columns - 1) >> layer) + 1, ((grid.rows - 1) >> layer) + 1};
        std::vector<std::uint8_t> found(static_cast<std::size_t>(all.columns) *
                                        static_cast<std::size_t>(all.rows));
        levels.read(layer, all, found.data());
        for (std::int32_t j = 0; j < all.rows; ++j)
            for (std::int32_t i = 0; i < all.columns; ++i) {
                const std::uint8_t code = found[static_cast<std::size_t>(j * all.columns + i)];
                ASSERT_EQ(DeviationScale::exceeded(code), expected.at(i << layer, j << layer))
                    << name << " layer " << layer << " at " << i << " " << j;
                ASSERT_GE(levels.scale().greatestMetres(code),
                          expected.deviationAt(i << layer, j << layer))
                    << name << " layer " << layer << " at " << i << " " << j;
            }
    }
}

TEST(VertexLevels, AreTheDefinitionsOnHardGrids) {
    for (int kind = 0; kind < test::kGridKinds; ++kind)
        expectTheDefinition(test::hardGrid(static_cast<GridKind>(kind), 150, 271, 3),
                            name(static_cast<GridKind>(kind)));
}

TEST(VertexLevels, AreTheDefinitionsForAnyShape) {
    for (const auto& [columns, rows] : {std::pair{2, 2},
                                        {3, 3},
                                        {2, 300},
                                        {129, 129},
                                        {130, 128},
                                        {257, 131},
                                        {513, 20},
                                        {640, 129},
                                        {1030, 40},
                                        {33, 1300}})
        expectTheDefinition(test::hardGrid(GridKind::Smooth, columns, rows, 8),
                            std::to_string(columns) + " x " + std::to_string(rows));
}

TEST(VertexLevels, AreTheDefinitionsWithHoles) {
    Random random(9);
    HeightGrid grid = test::hardGrid(GridKind::Smooth, 300, 262, 2);
    for (int k = 0; k < 12; ++k) grid.row(random.integer(0, 261))[random.integer(0, 299)] = kNodata;
    for (std::int32_t i = 60; i < 300; ++i) grid.row(128)[i] = kNodata;
    for (std::int32_t j = 140; j < 262; ++j) std::fill_n(grid.row(j) + 130, 120, kNodata);
    expectTheDefinition(grid, "holes");
}

TEST(VertexLevels, ComeBackFromTheirState) {
    const HeightGrid grid = test::hardGrid(GridKind::Smooth, 200, 300, 2);
    test::GridModel model(grid);
    VertexLevels levels(model.model(), model.scratch());
    levels.setThresholds(thresholdsFor(grid));
    ASSERT_TRUE(levels.measure({}).ok());
    ASSERT_TRUE(levels.join({}).ok());
    ASSERT_TRUE(levels.finish({}).ok());
    test::GridModel other(grid);
    VertexLevels restored(other.model(), other.scratch());
    ASSERT_TRUE(restored.restore(levels.state()));
    EXPECT_EQ(restored.state(), levels.state());
    std::vector<std::byte> cut = levels.state();
    cut.resize(cut.size() / 2);
    EXPECT_FALSE(restored.restore(cut));
}

}  // namespace
}  // namespace eyrie::terrain
