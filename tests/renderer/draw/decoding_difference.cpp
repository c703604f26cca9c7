// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/draw/decoding_difference.h"

#include <algorithm>

#include "renderer/draw/terrain_tiles.h"
#include "renderer/gl/debug_output.h"
#include "renderer/gl/egl_context.h"
#include "renderer/terrain/tile_bytes.h"

namespace eyrie::test {
namespace {

using draw::DeviceTile;
using terrain::PageForm;
using terrain::TileGeometry;

/// One context and decoder for all tests: compiling takes longer than they do.
draw::TileDecoder& decoder() {
    static const auto context = [] {
        gl::setOnGlError(gl::OnGlError::Abort);
        return gl::EglContext::create(-1).value();
    }();
    static auto decoder = draw::TileDecoder::create().value();
    return decoder;
}

template <typename T>
std::vector<T> readBack(const DeviceTile& tile, GLintptr first, std::size_t count) {
    std::vector<T> values(count);
    if (count != 0)
        glGetNamedBufferSubData(tile.buffer.id(), first, static_cast<GLsizeiptr>(count * sizeof(T)),
                                values.data());
    return values;
}

std::string difference(const TileGeometry& expected, const TileGeometry& outlined,
                       const DeviceTile& tile) {
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
    if (!std::ranges::equal(readBack<std::uint32_t>(tile, 0, expected.words.size()),
                            expected.words))
        return "vertices";
    if (!std::ranges::equal(
            readBack<std::uint16_t>(tile, tile.indexOffset, expected.indices.size()),
            expected.indices))
        return "indices";
    return "";
}

}  // namespace

std::string decodingDifference(const std::vector<std::uint32_t>& bytes, std::size_t* tiles) {
    const auto expected = terrain::Page::decode(bytes, "page");
    const auto outlined = terrain::Page::decode(bytes, "page", PageForm::Outlines);
    if (!expected.ok() || !outlined.ok())
        return expected.status() == outlined.status()
                   ? ""
                   : expected.status().ToString() + " / " + outlined.status().ToString();
    std::vector<DeviceTile> made;  // all before any is looked at, as paging does
    for (int place = 0; place < 16; ++place) made.emplace_back(outlined->tile(place), &decoder());
    decoder().publish();
    for (int place = 0; place < 16; ++place) {
        if (tiles != nullptr && !expected->tile(place).isEmpty())
            ++*tiles;
        if (const auto found = difference(expected->tile(place), outlined->tile(place),
                                          made[static_cast<std::size_t>(place)]);
            !found.empty())
            return "tile " + std::to_string(place) + ": " + found;
    }
    return "";
}

}  // namespace eyrie::test
