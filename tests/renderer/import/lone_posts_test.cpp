// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/lone_posts.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::import {
namespace {

using terrain::HeightGrid;
using terrain::PostRect;

HeightGrid gridWith(double share, std::uint64_t seed) {
    HeightGrid grid = test::hardGrid(test::GridKind::Noise, 40, 30, seed);
    test::Random random(seed);
    for (float& height : grid.heights) height = random.unit() < share ? height : terrain::kNodata;
    return grid;
}

int dataIn(const HeightGrid& grid, std::int32_t i, std::int32_t j) {
    int data = 0;
    for (const std::int32_t row : {j, j + 1})
        for (const std::int32_t column : {i, i + 1})
            data += column >= 0 && row >= 0 && column < grid.columns && row < grid.rows &&
                            !std::isnan(grid.at(column, row))
                        ? 1
                        : 0;
    return data;
}

/// As the header says, of the whole grid.
bool isLone(const HeightGrid& grid, std::int32_t i, std::int32_t j) {
    return !std::isnan(grid.at(i, j)) && dataIn(grid, i, j) < 3 && dataIn(grid, i - 1, j) < 3 &&
           dataIn(grid, i, j - 1) < 3 && dataIn(grid, i - 1, j - 1) < 3;
}

/// Counts how often it is read.
class CountedSource : public GridHeightSource {
public:
    using GridHeightSource::GridHeightSource;
    absl::Status read(const PostRect& window, float* out) override {
        ++reads;
        return GridHeightSource::read(window, out);
    }
    int reads = 0;
};

std::vector<float> withoutLone(CountedSource& source, const PostRect& window) {
    std::vector<float> posts(static_cast<std::size_t>(window.columns) *
                             static_cast<std::size_t>(window.rows));
    EXPECT_TRUE(source.read(window, posts.data()).ok());
    const auto onBorder = lonePostsOnBorder(source, window, posts);
    EXPECT_TRUE(onBorder.ok()) << onBorder.status();
    dropLonePosts(window, *onBorder, posts);
    return posts;
}

TEST(LonePosts, AreTheSameWhateverTheWindow) {
    test::Random random(3);
    int lone = 0;
    for (int turn = 0; turn < 400; ++turn) {
        const HeightGrid grid = gridWith(0.2 + 0.1 * (turn % 7), static_cast<std::uint64_t>(turn));
        PostRect window{random.integer(0, 38), random.integer(0, 28), 0, 0};
        window.columns = random.integer(2, grid.columns - window.i);
        window.rows = random.integer(2, grid.rows - window.j);
        CountedSource source(grid);
        const std::vector<float> posts = withoutLone(source, window);
        for (std::int32_t v = 0; v < window.rows; ++v)
            for (std::int32_t u = 0; u < window.columns; ++u) {
                const std::int32_t i = window.i + u, j = window.j + v;
                const float left = posts[static_cast<std::size_t>(v * window.columns + u)];
                const bool isData = !std::isnan(grid.at(i, j)) && !isLone(grid, i, j);
                ASSERT_EQ(!std::isnan(left), isData) << turn << ": " << i << " " << j;
                ASSERT_TRUE(!isData || left == grid.at(i, j));
                lone += isLone(grid, i, j) ? 1 : 0;
            }
    }
    EXPECT_GT(lone, 1000);
}

TEST(LonePosts, TakeNoReadingBeyondWhereTheWindowTells) {
    HeightGrid grid = test::hardGrid(test::GridKind::Noise, 40, 30, 1);
    grid.row(12)[20] = terrain::kNodata;
    CountedSource source(grid);
    const PostRect window{10, 10, 20, 10};
    withoutLone(source, window);
    EXPECT_EQ(source.reads, 1);

    // The first row's ground may be beyond it; so may that of its ends, to the left and right.
    for (std::int32_t i = 0; i < grid.columns; ++i) grid.row(11)[i] = terrain::kNodata;
    withoutLone(source, window);
    EXPECT_EQ(source.reads, 1 + 4);
}

}  // namespace
}  // namespace eyrie::import
