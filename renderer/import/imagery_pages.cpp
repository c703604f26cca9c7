// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/imagery_pages.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "fabric/status.h"
#include "renderer/terrain/imagery/bc1.h"
#include "renderer/terrain/imagery/texel_filter.h"
#include "renderer/terrain/imagery/texture_page.h"

namespace eyrie::import {
namespace {

using terrain::TexelRect;
using terrain::TextureId;

/// How far blocks are from what they were made of.
struct BlockLoss {
    std::uint64_t squares = 0;  ///< of red, green and blue
    std::uint64_t covered = 0;  ///< texels

    void add(const BlockLoss& other) {
        squares += other.squares;
        covered += other.covered;
    }
    double psnrDb() const {
        return 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(covered) /
                               static_cast<double>(squares));
    }
};

/// One tile on its way: texels, then a page.
struct Tile {
    TextureId id;
    TexelRect rect;  ///< border included
    std::vector<fabric::Rgba> texels;
    std::vector<std::byte> page;
    BlockLoss loss;
};
using TilePointer = std::shared_ptr<Tile>;

/// Encodes one tile's texels block by block.
class TileEncoder {
public:
    TileEncoder(Tile& tile, const terrain::TexturePyramid& pyramid)
        : tile_(tile),
          blocksX_(tile.rect.columns / terrain::kBlockSide),
          blocksY_(tile.rect.rows / terrain::kBlockSide),
          ownColumns_(pyramid.width(tile.id.level)),
          ownRows_(pyramid.height(tile.id.level)) {}

    /// Leaves the page empty where all is a hole.
    void encode() {
        std::vector<terrain::Bc1Block> blocks;
        blocks.reserve(static_cast<std::size_t>(blocksX_) * static_cast<std::size_t>(blocksY_));
        for (std::int32_t y = 0; y < blocksY_; ++y)
            for (std::int32_t x = 0; x < blocksX_; ++x) {
                const terrain::BlockTexels texels = texelsOf(x, y);
                blocks.push_back(terrain::encodeBc1(texels));
                measure(x, y, texels, blocks.back());
            }
        const bool isHole =
            std::all_of(blocks.begin(), blocks.end(),
                        [](const terrain::Bc1Block& block) { return block == terrain::kBc1Hole; });
        if (!isHole)
            tile_.page = terrain::TexturePage::encode(blocks, blocksX_);
    }

private:
    terrain::BlockTexels texelsOf(std::int32_t blockX, std::int32_t blockY) const {
        terrain::BlockTexels block;
        for (std::int32_t v = 0; v < terrain::kBlockSide; ++v)
            std::copy_n(tile_.texels.data() +
                            std::ptrdiff_t{blockY * terrain::kBlockSide + v} * tile_.rect.columns +
                            blockX * terrain::kBlockSide,
                        terrain::kBlockSide, block.begin() + v * terrain::kBlockSide);
        return block;
    }

    /// Of texels of the tile's own only: neither border nor beyond the level's edge.
    void measure(std::int32_t blockX, std::int32_t blockY, const terrain::BlockTexels& texels,
                 const terrain::Bc1Block& block) {
        if (tile_.id.level != 0 || blockX == 0 || blockY == 0 || blockX + 1 == blocksX_ ||
            blockY + 1 == blocksY_)
            return;
        const terrain::BlockTexels drawn = terrain::decodeBc1(block);
        const auto square = [](int a, int b) {
            return static_cast<std::uint64_t>((a - b) * (a - b));
        };
        for (std::size_t k = 0; k < texels.size(); ++k) {
            const std::int64_t x =
                tile_.rect.x + blockX * terrain::kBlockSide + std::int64_t(k % 4);
            const std::int64_t y =
                tile_.rect.y + blockY * terrain::kBlockSide + std::int64_t(k / 4);
            if (texels[k].a < 128 || x >= ownColumns_ || y >= ownRows_)
                continue;
            ++tile_.loss.covered;
            tile_.loss.squares += square(texels[k].r, drawn[k].r) +
                                  square(texels[k].g, drawn[k].g) + square(texels[k].b, drawn[k].b);
        }
    }

    Tile& tile_;
    std::int32_t blocksX_;
    std::int32_t blocksY_;
    std::int64_t ownColumns_;
    std::int64_t ownRows_;
};

/// Makes one level after the other.
class ImageryLine {
public:
    ImageryLine(ImagerySource& source, TexelStore& store, const terrain::Scratch& scratch,
                const ImportControl& control, terrain::EytWriter& writer)
        : source_(source), store_(store), scratch_(scratch), control_(control), writer_(writer) {
        imagery_.pyramid = source.pyramid();
        imagery_.tiles.resize(imagery_.pyramid.tileCount());
    }

    absl::StatusOr<terrain::ImageryIndex> run(const std::string& name) {
        for (int level = 0; level < imagery_.pyramid.levels(); ++level)
            RETURN_IF_ERROR(makeLevel(level));
        if (loss_.covered == 0)
            return absl::InvalidArgumentError(fmt::format(
                "{}: the terrain lies where no picture has a pixel (alpha 0 or nodata); check "
                "their coordinates and CRS (gdalinfo)",
                name));
        imagery_.psnrDb = loss_.psnrDb();
        imagery_.coveredTexels = loss_.covered;
        return std::move(imagery_);
    }

private:
    const terrain::TexturePyramid& pyramid() const { return source_.pyramid(); }

    absl::Status makeLevel(int level) {
        std::uint32_t next = 0;
        const auto tokens = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
        tbb::parallel_pipeline(
            tokens, tbb::make_filter<void, TilePointer>(tbb::filter_mode::serial_in_order,
                                                        [&](tbb::flow_control& flow) {
                                                            TilePointer tile = begin(level, next++);
                                                            if (!tile)
                                                                flow.stop();
                                                            return tile;
                                                        }) &
                        tbb::make_filter<TilePointer, TilePointer>(tbb::filter_mode::parallel,
                                                                   [&](const TilePointer& tile) {
                                                                       make(*tile);
                                                                       return tile;
                                                                   }) &
                        tbb::make_filter<TilePointer, void>(
                            tbb::filter_mode::serial_in_order,
                            [&](const TilePointer& tile) { write(*tile); }));
        RETURN_IF_ERROR(readStatus_);
        return writeStatus_;
    }

    /// The next tile of a level, with its texels where they come from the pictures; null at the
    /// end, or when there is no going on.
    TilePointer begin(int level, std::uint32_t number) {
        const auto across = static_cast<std::uint32_t>(pyramid().tilesX(level));
        const auto down = static_cast<std::uint32_t>(pyramid().tilesY(level));
        if (number >= across * down || hasFailed_)
            return nullptr;
        readStatus_ = scratch_.status();
        if (readStatus_.ok())
            readStatus_ = control_.check();
        if (!readStatus_.ok())
            return nullptr;
        const std::uint32_t row = number / across;
        auto tile = std::make_shared<Tile>();
        tile->id = {level, static_cast<std::int32_t>(number % across),
                    static_cast<std::int32_t>(source_.isLastRowFirst() ? down - 1 - row : row)};
        tile->rect = pyramid().texels(tile->id);
        tile->texels.resize(static_cast<std::size_t>(tile->rect.columns) *
                            static_cast<std::size_t>(tile->rect.rows));
        if (level == 0)
            readStatus_ = source_.read(tile->rect, tile->texels);
        return readStatus_.ok() ? tile : nullptr;
    }

    void make(Tile& tile) const {
        if (tile.id.level > 0)
            store_.read(tile.id.level, tile.rect, tile.texels);
        if (tile.id != pyramid().top())
            storeHalf(tile);
        TileEncoder(tile, pyramid()).encode();
        tile.texels = {};
    }

    /// What the tile's own texels become one level up.
    void storeHalf(const Tile& tile) const {
        const auto own = [](std::int64_t all, std::int64_t first) {
            return static_cast<std::int32_t>(
                std::min<std::int64_t>(terrain::kTextureSide, all - first));
        };
        const std::int32_t columns =
            own(pyramid().width(tile.id.level), tile.rect.x + terrain::kTextureBorder);
        const std::int32_t rows =
            own(pyramid().height(tile.id.level), tile.rect.y + terrain::kTextureBorder);
        std::vector<fabric::Rgba> inner;
        inner.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        for (std::int32_t v = 0; v < rows; ++v) {
            const auto first = tile.texels.begin() +
                               std::ptrdiff_t{v + terrain::kTextureBorder} * tile.rect.columns +
                               terrain::kTextureBorder;
            inner.insert(inner.end(), first, first + columns);
        }
        std::vector<fabric::Rgba> half(static_cast<std::size_t>((columns + 1) / 2) *
                                       static_cast<std::size_t>((rows + 1) / 2));
        terrain::halve(inner, columns, rows, half);
        store_.write(tile.id, half);
    }

    void write(const Tile& tile) {
        if (hasFailed_)
            return;
        absl::StatusOr<terrain::PageRecord> record = writer_.addPage(tile.page);
        if (!record.ok()) {
            writeStatus_ = record.status();
            hasFailed_ = true;
            return;
        }
        imagery_.tiles[pyramid().tileIndex(tile.id)] = *record;
        loss_.add(tile.loss);
        control_.report("imagery", static_cast<double>(++written_) / pyramid().tileCount());
    }

    ImagerySource& source_;
    TexelStore& store_;
    const terrain::Scratch& scratch_;
    const ImportControl& control_;
    terrain::EytWriter& writer_;
    terrain::ImageryIndex imagery_;
    BlockLoss loss_;
    std::uint32_t written_ = 0;
    absl::Status readStatus_;   // by the first stage
    absl::Status writeStatus_;  // by the last stage
    std::atomic<bool> hasFailed_ = false;
};

}  // namespace

absl::StatusOr<terrain::ImageryIndex> buildImagery(ImagerySource& source, const std::string& name,
                                                   TexelStore& store,
                                                   const terrain::Scratch& scratch,
                                                   const ImportControl& control,
                                                   terrain::EytWriter& writer) {
    ASSIGN_OR_RETURN(terrain::ImageryIndex imagery,
                     ImageryLine(source, store, scratch, control, writer).run(name));
    RETURN_IF_ERROR(scratch.status());
    return imagery;
}

}  // namespace eyrie::import
