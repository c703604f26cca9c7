// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/vertex_packing.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::terrain {
namespace {

/// Through HeightPacking and words and back.
std::vector<TileVertex> repacked(const std::vector<TileVertex>& vertices) {
    const HeightPacking packing = chooseHeightPacking(vertices);
    std::vector<std::uint32_t> positions;
    std::vector<std::uint32_t> heights;
    for (const TileVertex& vertex : vertices) {
        positions.push_back(static_cast<std::uint32_t>(vertex.x | vertex.y << 10));
        heights.push_back(static_cast<std::uint32_t>(vertex.q - packing.base) >> packing.shift);
    }
    std::vector<std::uint32_t> words(vertices.size() *
                                     static_cast<std::size_t>(packing.wordsPerVertex));
    packVertices(positions, heights, packing.wordsPerVertex, words);
    std::vector<TileVertex> out;
    for (std::size_t n = 0; n < vertices.size(); ++n)
        out.push_back(
            unpackVertex(words, packing.wordsPerVertex, n, packing.base, 1 << packing.shift));
    return out;
}

RC_GTEST_PROP(VertexPacking, UnpacksToWhatWasPacked, ()) {
    const auto step = 1 << *rc::gen::inRange(0, 5);
    const auto base = *rc::gen::inRange(-8000000, 8000000);
    const auto relief = *rc::gen::element(1, 300, 4096, 500000);
    std::vector<TileVertex> vertices;
    const auto count = *rc::gen::inRange<std::size_t>(1, 40);
    for (std::size_t k = 0; k < count; ++k)
        vertices.push_back({*rc::gen::inRange(0, 257), *rc::gen::inRange(0, 257),
                            base + step * *rc::gen::inRange(0, relief)});
    RC_ASSERT(repacked(vertices) == vertices);
}

TEST(VertexPacking, NeedsTwoWordsWhereReliefExceeds4095Steps) {
    for (const std::int32_t base : {-11034, 0, 8849}) {
        for (const auto& [relief, words] : {std::pair{4095, 1}, {4097, 2}}) {
            const std::vector<TileVertex> vertices = {
                {0, 0, base}, {2, 0, base + 1}, {0, 2, base + relief}};
            EXPECT_EQ(chooseHeightPacking(vertices).wordsPerVertex, words) << relief;
            EXPECT_EQ(repacked(vertices), vertices);
        }
        const std::vector<TileVertex> even = {{0, 0, base}, {2, 0, base + 2}, {0, 2, base + 8190}};
        EXPECT_EQ(chooseHeightPacking(even).wordsPerVertex, 1);
        EXPECT_EQ(chooseHeightPacking(even).shift, 1);
        EXPECT_EQ(repacked(even), even);
    }
}

}  // namespace
}  // namespace eyrie::terrain
