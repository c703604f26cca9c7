// SPDX-License-Identifier: Apache-2.0
// What the device makes of a page's outlines, held against what the CPU decodes from the same
// bytes.
#include "renderer/draw/tile_decoder.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/import/terrain_import.h"
#include "tests/renderer/draw/decoding_difference.h"
#include "tests/renderer/terrain/sample_pages.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using terrain::PageForm;
using test::GridKind;
using test::SamplePage;
using Words = std::vector<std::uint32_t>;

std::string difference(const test::SampleTerrain& terrain) {
    for (const SamplePage& page : test::samplePages(terrain))
        if (const std::string found = test::decodingDifference(page.bytes); !found.empty())
            return "level " + std::to_string(page.level) + ", " + found;
    return "";
}

RC_GTEST_PROP(TileDecoder, MakesTheVerticesAndIndicesOfTheCpuBitForBit, ()) {
    test::SampleTerrain terrain;
    terrain.kind = static_cast<GridKind>(*rc::gen::inRange(0, test::kGridKinds));
    terrain.columns = *rc::gen::inRange(2, 100);
    terrain.rows = *rc::gen::inRange(2, 100);
    terrain.stepMetres = *rc::gen::element(1.0, 1.0 / 16, 1.0 / 1024);
    terrain.nodataShare = *rc::gen::element(0.0, 0.0, 0.01, 0.2, 0.9);
    terrain.finestThresholdMetres = *rc::gen::element(0.0, 0.5, 8.0);
    terrain.shareWithNormals = *rc::gen::element(0.0, 0.5);
    terrain.seed = *rc::gen::arbitrary<std::uint32_t>();
    RC_ASSERT(difference(terrain) == "");
}

TEST(TileDecoder, MakesTilesAsThinAsTheyCanBe) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {2, 300}, {300, 2}, {3, 3}, {34, 33}})
        for (const GridKind kind : {GridKind::Noise, GridKind::Flat, GridKind::Cliff})
            EXPECT_EQ(
                difference(test::SampleTerrain{.kind = kind, .columns = columns, .rows = rows}), "")
                << columns << " x " << rows << ", " << test::name(kind);
}

/// Tiles of every size, full, both forms of vertices, and between samples those of a finer level.
TEST(TileDecoder, MakesLevelsThatLeaveOutPosts) {
    for (const double step : {1.0, 1.0 / 1024})
        EXPECT_EQ(difference(test::SampleTerrain{
                      .kind = GridKind::Noise, .columns = 600, .rows = 530, .stepMetres = step}),
                  "");
}

/// Damaged bits of which a checksum would warn: refused alike, and drawn alike where they pass.
RC_GTEST_PROP(TileDecoder, FindsTheSameWrongWithDamagedPages, ()) {
    static const std::vector<SamplePage> pages = [] {
        auto dense = test::samplePages({.kind = GridKind::Noise, .columns = 50, .rows = 70});
        auto sparse = test::samplePages(
            {.kind = GridKind::Smooth, .columns = 260, .rows = 40, .nodataShare = 0.1});
        dense.insert(dense.end(), std::make_move_iterator(sparse.begin()),
                     std::make_move_iterator(sparse.end()));
        return dense;
    }();
    Words bytes = pages[*rc::gen::inRange<std::size_t>(0, pages.size())].bytes;
    const int flips = *rc::gen::inRange(1, 4);
    for (int flip = 0; flip < flips; ++flip) {
        // Half of them in the header, which is a small part of most pages.
        const std::size_t end =
            *rc::gen::arbitrary<bool>() ? std::min<std::size_t>(69, bytes.size()) : bytes.size();
        bytes[*rc::gen::inRange<std::size_t>(0, end)] ^= 1U << *rc::gen::inRange(0, 32);
    }
    RC_ASSERT(test::decodingDifference(bytes) == "");
}

/// Every tile of every level: mountains, and projected data with voids around them.
TEST(TileDecoder, MakesEveryTileOfRealTerrain) {
    const test::TemporaryFolder folder;
    for (const char* name : {"SainteHelens.dem.gz", "utah_zion_srtm90.tif", "N44E005_UTM.tif.gz"}) {
        const std::string path = std::string(EYRIE_SOURCE_DIR "/../shared/data/terrain/") + name;
        const std::string source = path.ends_with(".gz") ? "/vsigzip/" + path : path;
        const std::string out = folder.path("dem.eyt");
        const auto report = import::importTerrain({source}, out, {}, {});
        ASSERT_TRUE(report.ok()) << report.status();
        const auto file = terrain::EytFile::open(out).value();
        std::size_t tiles = 0;
        for (std::uint32_t page = 0; page < file->index().pages.size(); ++page) {
            const Words bytes = file->readPageBytes(page).value();
            EXPECT_EQ(test::decodingDifference(bytes, &tiles), "") << name << ", page " << page;
        }
        EXPECT_GE(tiles, 100U) << name;
    }
}

TEST(TileDecoder, SendsAQuarterOfTheBytes) {
    std::size_t outlines = 0;
    std::size_t tiles = 0;
    for (const SamplePage& page : test::samplePages({.columns = 257, .rows = 257})) {
        const auto decoded = terrain::Page::decode(page.bytes, "page", PageForm::Outlines).value();
        for (int place = 0; place < 16; ++place) {
            outlines += decoded.tile(place).outline.size_bytes();
            tiles += decoded.tile(place).wordBytes() + decoded.tile(place).indexBytes();
        }
    }
    EXPECT_LE(4 * outlines, tiles);
}

}  // namespace
}  // namespace eyrie
