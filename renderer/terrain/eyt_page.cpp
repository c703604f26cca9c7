// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdlib>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/terrain/codec/geometry_decoder.h"
#include "renderer/terrain/codec/normal_codec.h"
#include "renderer/terrain/codec/tile_outline.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_layout.h"

namespace eyrie::terrain {
namespace {

constexpr TileHeader kNoTile;

bool isEmpty(const TileHeader& tile) { return std::memcmp(&tile, &kNoTile, sizeof tile) == 0; }

std::size_t samplesOf(std::int32_t cells) {
    return (static_cast<std::size_t>(cells) + 1) * (static_cast<std::size_t>(cells) + 1);
}

/// The field that no encoder writes so, or null.
const char* impossibleField(const PageHeader& page) {
    const std::uint32_t cells = page.cells;
    if (cells < kFinestTileCells || cells > kMaxTileCells || !std::has_single_bit(cells))
        return "cells";
    if (page.finerStep != 1 && page.finerStep != 2)
        return "finerStep";
    if (page.normalTiles >> page.tiles.size() != 0)
        return "normalTiles";
    if (page.wordBytes % 2 != 0 || page.rawBytes % 2 != 0)
        return "wordBytes or rawBytes";
    return nullptr;
}

const char* impossibleField(const TileHeader& tile, std::int32_t cells) {
    const std::size_t perimeter = 8 * static_cast<std::size_t>(cells);
    if (std::abs(std::int64_t{tile.baseHeight}) > kMaxHeightSteps)
        return "baseHeight";
    if (tile.vertices < 3 || tile.vertices > samplesOf(cells) + perimeter)
        return "vertices";
    if (tile.triangles < 1 || tile.triangles > 2 * samplesOf(cells) + perimeter)
        return "triangles";
    if (tile.limitX < 1 || tile.limitX > 2 * cells || tile.limitY < 1 || tile.limitY > 2 * cells)
        return "limitX or limitY";
    if (tile.finerEdges >= 1 << kEdges)
        return "finerEdges";
    if (tile.wordsPerVertex != 1 && tile.wordsPerVertex != 2)
        return "wordsPerVertex";
    if (tile.heightShift > std::bit_width(2U * kMaxHeightSteps))
        return "heightShift";
    if (tile.isSparse > 1)
        return "isSparse";
    return nullptr;
}

/// Decodes the tiles of one page into one array.
class PageReader {
public:
    /// `bytes` begin with a header, which was checked: they hold what it says.
    PageReader(const std::uint8_t* bytes, const PageHeader& header, PageForm form)
        : header_(header),
          form_(form),
          geometry_({reinterpret_cast<const std::uint16_t*>(bytes + sizeof header),
                     header.wordBytes / sizeof(std::uint16_t)},
                    {bytes + sizeof header + header.wordBytes, header.rawBytes}) {
        if (header.normalTiles != 0)
            normals_.emplace(std::span(bytes + sizeof header + header.wordBytes + header.rawBytes,
                                       header.normalBytes),
                             header.cells);
    }

    /// What is wrong, or null.
    const char* begin() {
        if (const char* wrong = geometry_.begin())
            return wrong;
        return normals_ && !normals_->begin() ? "shares of normal symbols" : nullptr;
    }

    /// Words of one tile in the array.
    std::size_t wordsOf(std::size_t place) const {
        const TileHeader& tile = header_.tiles[place];
        return geometryWords(tile) + (hasNormals(place) ? normalWords() : 0);
    }

    /// Decodes the next tile to `out`, wordsOf(place) words. What is wrong, or null.
    const char* decode(std::size_t place, std::uint32_t* out, TileGeometry& tile) {
        const TileHeader& header = header_.tiles[place];
        if (!isEmpty(header))
            if (const char* wrong = decodeGeometry(header, out, tile))
                return wrong;
        if (!hasNormals(place))
            return nullptr;
        const std::span normals(reinterpret_cast<std::int8_t*>(out + geometryWords(header)),
                                2 * samplesOf(header_.cells));
        if (!normals_->decode(normals))
            return "length of the normals' bits";
        tile.cells = header_.cells;
        tile.normals = normals;
        return nullptr;
    }

    const char* finish() const {
        if (const char* wrong = geometry_.finish())
            return wrong;
        const bool isAtEnd = normals_ ? normals_->isAtEnd() : header_.normalBytes == 0;
        return isAtEnd ? nullptr : "length of the normals' bits";
    }

private:
    bool hasNormals(std::size_t place) const { return (header_.normalTiles >> place & 1) != 0; }

    const char* decodeGeometry(const TileHeader& header, std::uint32_t* out, TileGeometry& tile) {
        const TileShape shape{header_.cells, header_.finerStep, header.limitX, header.limitY,
                              header.finerEdges};
        if (form_ == PageForm::Outlines) {
            const std::span<std::uint32_t> outline(out, geometryWords(header));
            if (const char* wrong = geometry_.decodeOutline(header, shape, outline, tile.parts))
                return wrong;
            tile.outline = outline;
        } else {
            const std::span<std::uint32_t> words(out, vertexWords(header));
            const std::span indices(reinterpret_cast<std::uint16_t*>(out + words.size()),
                                    3 * std::size_t{header.triangles});
            if (const char* wrong = geometry_.decode(header, shape, words, indices, tile.parts))
                return wrong;
            tile.words = words;
            tile.indices = indices;
        }
        tile.vertices = header.vertices;
        tile.wordsPerVertex = header.wordsPerVertex;
        tile.baseHeight = header.baseHeight;
        tile.heightMultiplier = 1 << header.heightShift;
        tile.cells = header_.cells;
        return nullptr;
    }

    static std::size_t vertexWords(const TileHeader& tile) {
        return std::size_t{tile.vertices} * tile.wordsPerVertex;
    }
    static std::size_t indexWords(const TileHeader& tile) {
        return (3 * std::size_t{tile.triangles} + 1) / 2;
    }
    std::size_t geometryWords(const TileHeader& tile) const {
        if (isEmpty(tile))
            return 0;
        return form_ == PageForm::Outlines ? outlineWords(tile, header_.cells)
                                           : vertexWords(tile) + indexWords(tile);
    }
    std::size_t normalWords() const { return (2 * samplesOf(header_.cells) + 3) / 4; }

    const PageHeader& header_;
    PageForm form_;
    GeometryDecoder geometry_;
    std::optional<NormalDecoder> normals_;  ///< empty: no tile has any
};

absl::Status corrupt(const std::string& name, const std::string& what) {
    return absl::DataLossError(fmt::format("{}: {}; import the elevation model again", name, what));
}

absl::Status corruptTile(const std::string& name, std::size_t place, const char* what) {
    return corrupt(name, fmt::format("tile {}: impossible {}", place, what));
}

/// A header all of whose fields are possible and whose parts add up to `bytes`.
absl::StatusOr<PageHeader> readHeader(std::span<const std::uint32_t> page,
                                      const std::string& name) {
    PageHeader header;
    if (page.size_bytes() < sizeof header)
        return corrupt(name, fmt::format("{} bytes are less than its header", page.size_bytes()));
    std::memcpy(static_cast<void*>(&header), page.data(), sizeof header);
    if (const char* field = impossibleField(header))
        return corrupt(name, fmt::format("impossible {}", field));
    const std::uint64_t bytes =
        sizeof header + std::uint64_t{header.wordBytes} + header.rawBytes + header.normalBytes;
    if (roundUp(bytes, sizeof(std::uint32_t)) != page.size_bytes())
        return corrupt(name, fmt::format("{} bytes, its header says {}", page.size_bytes(), bytes));
    for (std::size_t place = 0; place < header.tiles.size(); ++place)
        if (const TileHeader& tile = header.tiles[place]; !isEmpty(tile))
            if (const char* field = impossibleField(tile, header.cells))
                return corruptTile(name, place, field);
    return header;
}

}  // namespace

absl::StatusOr<Page> Page::decode(std::span<const std::uint32_t> bytes, const std::string& name,
                                  PageForm form) {
    Page page;
    if (bytes.empty())
        return page;
    ASSIGN_OR_RETURN(const PageHeader header, readHeader(bytes, name));
    PageReader reader(reinterpret_cast<const std::uint8_t*>(bytes.data()), header, form);
    if (const char* wrong = reader.begin())
        return corrupt(name, fmt::format("impossible {}", wrong));
    std::size_t words = 0;
    for (std::size_t place = 0; place < header.tiles.size(); ++place)
        words += reader.wordsOf(place);
    page.storage_.resize(words);
    std::uint32_t* out = page.storage_.data();
    for (std::size_t place = 0; place < header.tiles.size(); ++place) {
        if (const char* wrong = reader.decode(place, out, page.tiles_[place]))
            return corruptTile(name, place, wrong);
        out += reader.wordsOf(place);
    }
    if (const char* wrong = reader.finish())
        return corrupt(name, fmt::format("impossible {}", wrong));
    return page;
}

}  // namespace eyrie::terrain
