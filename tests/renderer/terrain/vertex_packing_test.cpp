// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/vertex_packing.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::terrain {
namespace {

std::vector<TileVertex> unpacked(const PackedVertices& packed) {
    std::vector<TileVertex> vertices;
    const auto stride = static_cast<std::size_t>(packed.wordsPerVertex);
    for (std::size_t n = 0; n < packed.words.size() / stride; ++n)
        vertices.push_back(unpackVertex(packed.words, packed.wordsPerVertex, n, packed.baseHeight,
                                        packed.heightMultiplier));
    return vertices;
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
    RC_ASSERT(unpacked(packVertices(vertices)) == vertices);
}

TEST(VertexPacking, NeedsTwoWordsWhereReliefExceeds4095Steps) {
    for (const std::int32_t base : {-11034, 0, 8849}) {
        for (const auto& [relief, words] : {std::pair{4095, 1}, {4097, 2}}) {
            const std::vector<TileVertex> vertices = {
                {0, 0, base}, {2, 0, base + 1}, {0, 2, base + relief}};
            EXPECT_EQ(packVertices(vertices).wordsPerVertex, words) << relief;
            EXPECT_EQ(unpacked(packVertices(vertices)), vertices);
        }
        const std::vector<TileVertex> even = {{0, 0, base}, {2, 0, base + 2}, {0, 2, base + 8190}};
        EXPECT_EQ(packVertices(even).wordsPerVertex, 1);
        EXPECT_EQ(packVertices(even).heightMultiplier, 2);
        EXPECT_EQ(unpacked(packVertices(even)), even);
    }
}

}  // namespace
}  // namespace eyrie::terrain
