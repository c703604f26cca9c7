// SPDX-License-Identifier: Apache-2.0
// What the device makes of a page's outlines, held against what the CPU decodes from the same bytes.
#include "renderer/draw/tile_decoder.h"

#include <algorithm>
#include <memory>
#include <optional>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/draw/terrain_tiles.h"
#include "renderer/gl/debug_output.h"
#include "renderer/gl/egl_context.h"
#include "renderer/terrain/tile_bytes.h"
#include "tests/renderer/terrain/sample_pages.h"

namespace eyrie {
namespace {

using draw::DeviceTile;
using terrain::PageForm;
using terrain::TileGeometry;
using test::GridKind;
using test::SamplePage;
using Words = std::vector<std::uint32_t>;

/// One context and decoder for all tests: compiling takes longer than they do.
const draw::TileDecoder& decoder() {
    static const auto context = [] {
        gl::setOnGlError(gl::OnGlError::Abort);
        return gl::EglContext::create(-1).value();
    }();
    static const auto decoder = draw::TileDecoder::create().value();
    return decoder;
}

template <typename T>
std::vector<T> readBack(const DeviceTile& tile, GLintptr first, std::size_t count) {
    std::vector<T> values(count);
    if (count != 0)
        glGetNamedBufferSubData(tile.buffer.id(), first,
                                static_cast<GLsizeiptr>(count * sizeof(T)), values.data());
    return values;
}

std::string difference(const TileGeometry& expected, const TileGeometry& outlined) {
    if (!expected.isEmpty() && (!outlined.words.empty() || outlined.outline.empty()))
        return "is no outline";
    if (outlined.vertexCount() != expected.vertexCount() || outlined.parts != expected.parts ||
        outlined.wordsPerVertex != expected.wordsPerVertex || outlined.cells != expected.cells ||
        outlined.baseHeight != expected.baseHeight ||
        outlined.heightMultiplier != expected.heightMultiplier ||
        terrain::tileBytes(outlined) != terrain::tileBytes(expected))
        return "what is known of the tile";
    if (!std::ranges::equal(outlined.normals, expected.normals))
        return "normals";
    const DeviceTile tile(outlined, &decoder());
    if (!std::ranges::equal(readBack<std::uint32_t>(tile, 0, expected.words.size()),
                            expected.words))
        return "vertices";
    if (!std::ranges::equal(
            readBack<std::uint16_t>(tile, tile.indexOffset, expected.indices.size()),
            expected.indices))
        return "indices";
    return "";
}

/// In what the two ways to decode a page differ; empty: in nothing, not even in what they refuse.
std::string difference(const Words& bytes) {
    const auto expected = terrain::Page::decode(bytes, "page");
    const auto outlined = terrain::Page::decode(bytes, "page", PageForm::Outlines);
    if (!expected.ok() || !outlined.ok())
        return expected.status() == outlined.status()
                   ? ""
                   : expected.status().ToString() + " / " + outlined.status().ToString();
    for (int place = 0; place < 16; ++place)
        if (const auto found = difference(expected->tile(place), outlined->tile(place));
            !found.empty())
            return "tile " + std::to_string(place) + ": " + found;
    return "";
}

std::string difference(const test::SampleTerrain& terrain) {
    for (const SamplePage& page : test::samplePages(terrain))
        if (const std::string found = difference(page.bytes); !found.empty())
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
            EXPECT_EQ(difference(
                          test::SampleTerrain{.kind = kind, .columns = columns, .rows = rows}),
                      "")
                << columns << " x " << rows << ", " << test::name(kind);
}

/// Tiles of every size, full, both forms of vertices, and between samples those of a finer level.
TEST(TileDecoder, MakesLevelsThatLeaveOutPosts) {
    for (const double step : {1.0, 1.0 / 1024})
        EXPECT_EQ(difference(test::SampleTerrain{.kind = GridKind::Noise,
                                                 .columns = 600,
                                                 .rows = 530,
                                                 .stepMetres = step}),
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
    RC_ASSERT(difference(bytes) == "");
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
