// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/codec/symbol_shares.h"
#include "tests/renderer/terrain/sample_pages.h"

namespace eyrie {
namespace {

using test::GridKind;
using test::SamplePage;
using test::SampleTerrain;

/// In what any page differs once decoded; empty: in nothing.
std::string differences(const SampleTerrain& terrain) {
    for (const SamplePage& page : test::samplePages(terrain)) {
        const auto decoded = terrain::Page::decode(page.bytes, "page");
        if (!decoded.ok())
            return decoded.status().ToString();
        if (std::string found = test::broken(*decoded); !found.empty())
            return found;
        if (std::string found = test::difference(page, *decoded); !found.empty())
            return found;
    }
    return "";
}

RC_GTEST_PROP(PageCodec, DividesByASharesSizeExactly, ()) {
    const auto size = *rc::gen::inRange<std::uint32_t>(1, codec::kAllShares + 1);
    const codec::ReadyShare<codec::kSymbolBits> share({0, size});
    const std::uint64_t last = std::min<std::uint64_t>(share.limit, 1ULL << 32) - 1;
    const std::uint64_t multiple = *rc::gen::inRange<std::uint64_t>(0, last / size + 1) * size;
    for (const std::uint64_t x : {multiple, multiple - std::min<std::uint64_t>(multiple, 1), last})
        RC_ASSERT(share.quotient(static_cast<std::uint32_t>(x)) == x / size);
}

RC_GTEST_PROP(PageCodec, GivesBackEveryTileOfEveryLevel, ()) {
    SampleTerrain terrain;
    terrain.kind = static_cast<GridKind>(*rc::gen::inRange(0, test::kGridKinds));
    terrain.columns = *rc::gen::inRange(2, 170);
    terrain.rows = *rc::gen::inRange(2, 170);
    terrain.stepMetres = *rc::gen::element(1.0, 1.0 / 16, 1.0 / 1024);
    terrain.nodataShare = *rc::gen::element(0.0, 0.0, 0.01, 0.2, 0.9);
    terrain.finestThresholdMetres = *rc::gen::element(0.0, 0.5, 8.0);
    terrain.shareWithNormals = *rc::gen::element(0.0, 0.5, 1.0);
    terrain.hasNoisyNormals = *rc::gen::arbitrary<bool>();
    terrain.seed = *rc::gen::arbitrary<std::uint32_t>();
    RC_ASSERT(differences(terrain) == "");
}

TEST(PageCodec, GivesBackGridsAsThinAsTheyCanBe) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {2, 300}, {300, 2}, {3, 3}, {34, 33}})
        for (int kind = 0; kind < test::kGridKinds; ++kind)
            EXPECT_EQ(differences(
                          {.kind = static_cast<GridKind>(kind), .columns = columns, .rows = rows}),
                      "")
                << columns << " x " << rows << ", " << test::name(static_cast<GridKind>(kind));
}

/// Levels that leave out posts, whose finer neighbours have vertices between their samples.
TEST(PageCodec, GivesBackLevelsThatLeaveOutPosts) {
    std::set<int> levels;
    std::set<int> words;
    const SampleTerrain terrain{
        .kind = GridKind::Noise, .columns = 600, .rows = 530, .stepMetres = 1.0 / 1024};
    for (const SamplePage& page : test::samplePages(terrain)) {
        const auto decoded = terrain::Page::decode(page.bytes, "page");
        ASSERT_TRUE(decoded.ok()) << decoded.status();
        EXPECT_EQ(test::difference(page, *decoded), "");
        levels.insert(page.level);
        for (int place = 0; place < 16; ++place)
            if (!decoded->tile(place).isEmpty())
                words.insert(decoded->tile(place).wordsPerVertex);
    }
    EXPECT_EQ(levels, (std::set{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(words, (std::set{2}));
}

TEST(PageCodec, GivesAPageWithoutTrianglesForNoBytes) {
    const auto page = terrain::Page::decode({}, "none");
    ASSERT_TRUE(page.ok());
    for (int place = 0; place < 16; ++place) EXPECT_TRUE(page->tile(place).isEmpty());
}

TEST(PageCodec, TakesAtMostEightBitsATriangleOfSmoothTerrain) {
    std::uint64_t bytes = 0;
    std::uint64_t triangles = 0;
    for (const SamplePage& page : test::samplePages({.columns = 257, .rows = 257})) {
        const auto* header = reinterpret_cast<const std::uint32_t*>(page.bytes.data());
        bytes += 276 + header[0] + header[1];  // PageHeader, wordBytes and rawBytes
        for (const SamplePage::Tile& tile : page.tiles) triangles += tile.mesh.ownTriangles();
    }
    EXPECT_LE(8 * bytes, 8 * triangles);
}

}  // namespace
}  // namespace eyrie
