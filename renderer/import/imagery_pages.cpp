// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/imagery_pages.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <span>
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

double psnrDb(std::uint64_t squares, std::uint64_t covered) {
    return 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(covered) /
                           static_cast<double>(squares));
}

/// One tile on its way: texels, then what is made of them.
struct Tile {
    Tile(const TextureId& tile, const terrain::TexturePyramid& pyramid)
        : id(tile), rect(pyramid.texels(tile)) {}

    void makeRoom() {
        texels.resize(static_cast<std::size_t>(rect.columns) * static_cast<std::size_t>(rect.rows));
    }

    TextureId id;
    TexelRect rect;                    ///< border included
    std::vector<fabric::Rgba> texels;  ///< empty: nothing but holes
    TexturePiece made;
    absl::Status status;
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
            tile_.made.page = terrain::TexturePage::encode(blocks, blocksX_);
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
            ++tile_.made.coveredTexels;
            tile_.made.lossSquares += square(texels[k].r, drawn[k].r) +
                                      square(texels[k].g, drawn[k].g) +
                                      square(texels[k].b, drawn[k].b);
        }
    }

    Tile& tile_;
    std::int32_t blocksX_;
    std::int32_t blocksY_;
    std::int64_t ownColumns_;
    std::int64_t ownRows_;
};

/// Columns and rows of a tile's own texels.
struct OwnTexels {
    OwnTexels(const Tile& tile, const terrain::TexturePyramid& pyramid)
        : columns(own(pyramid.width(tile.id.level), tile.rect.x + terrain::kTextureBorder)),
          rows(own(pyramid.height(tile.id.level), tile.rect.y + terrain::kTextureBorder)) {}

    std::size_t halfTexels() const {
        return static_cast<std::size_t>((columns + 1) / 2) *
               static_cast<std::size_t>((rows + 1) / 2);
    }

    std::int32_t columns;
    std::int32_t rows;

private:
    static std::int32_t own(std::int64_t all, std::int64_t first) {
        return static_cast<std::int32_t>(
            std::min<std::int64_t>(terrain::kTextureSide, all - first));
    }
};

/// What the tile's own texels become one level up.
std::vector<fabric::Rgba> halved(const Tile& tile, const terrain::TexturePyramid& pyramid) {
    const OwnTexels own(tile, pyramid);
    std::vector<fabric::Rgba> inner;
    inner.reserve(static_cast<std::size_t>(own.columns) * static_cast<std::size_t>(own.rows));
    for (std::int32_t v = 0; v < own.rows; ++v) {
        const auto first = tile.texels.begin() +
                           std::ptrdiff_t{v + terrain::kTextureBorder} * tile.rect.columns +
                           terrain::kTextureBorder;
        inner.insert(inner.end(), first, first + own.columns);
    }
    std::vector<fabric::Rgba> half(own.halfTexels());
    terrain::halve(inner, own.columns, own.rows, half);
    return half;
}

bool areHoles(const std::vector<fabric::Rgba>& texels) {
    return std::ranges::count(texels, fabric::Rgba{0, 0, 0, 0}) == std::ssize(texels);
}

/// Turns a tile's texels into what is made of them. Of small pictures over a large terrain nearly
/// all tiles are empty.
void finish(Tile& tile, const terrain::TexturePyramid& pyramid) {
    if (!areHoles(tile.texels)) {
        if (tile.id != pyramid.top())
            tile.made.half = halved(tile, pyramid);
        if (areHoles(tile.made.half))
            tile.made.half = {};
        TileEncoder(tile, pyramid).encode();
    }
    tile.texels = {};
}

/// Runs tiles through three steps: begin, one after the other, null at the end; make, in parallel;
/// end, one after the other in the order they were begun.
template <typename Begin, typename Make, typename End>
void runTiles(Begin begin, Make make, End end) {
    const auto tokens = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
    tbb::parallel_pipeline(
        tokens,
        tbb::make_filter<void, TilePointer>(tbb::filter_mode::serial_in_order,
                                            [&](tbb::flow_control& flow) {
                                                TilePointer tile = begin();
                                                if (!tile)
                                                    flow.stop();
                                                return tile;
                                            }) &
            tbb::make_filter<TilePointer, TilePointer>(tbb::filter_mode::parallel,
                                                       [&](const TilePointer& tile) {
                                                           make(*tile);
                                                           return tile;
                                                       }) &
            tbb::make_filter<TilePointer, void>(tbb::filter_mode::serial_in_order,
                                                [&](const TilePointer& tile) { end(*tile); }));
}

/// Makes one level after the other.
class ImageryLine {
public:
    ImageryLine(ImagerySource& source, const NamedPictures& pictures, const PartSet* parts,
                TexelStore& store, const terrain::Scratch& scratch, const ImportControl& control,
                terrain::EytWriter& writer)
        : source_(source),
          pictures_(pictures),
          parts_(parts),
          store_(store),
          scratch_(scratch),
          control_(control),
          writer_(writer) {
        imagery_.pyramid = source.pyramid();
        imagery_.tiles.resize(imagery_.pyramid.tileCount());
    }

    absl::StatusOr<terrain::ImageryIndex> run(TerrainStages& stages) {
        for (int level = 0; level < imagery_.pyramid.levels(); ++level)
            RETURN_IF_ERROR(makeLevel(level, stages));
        if (covered_ == 0)
            return absl::InvalidArgumentError(fmt::format(
                "{}: the terrain lies where no picture has a pixel (alpha below half, or nodata); "
                "check their coordinates, CRS and alpha (gdalinfo)",
                pictures_.names));
        imagery_.psnrDb = psnrDb(lossSquares_, covered_);
        imagery_.coveredTexels = covered_;
        return std::move(imagery_);
    }

private:
    const terrain::TexturePyramid& pyramid() const { return source_.pyramid(); }

    /// Tiles of one level, one after the other as they are read.
    struct Batch {
        int level = 0;
        std::uint32_t first = 0;
        std::uint32_t end = 0;
    };
    /// A second of work or a few, which a killed import does again.
    static constexpr std::uint32_t kTilesAtOnce = 256;

    absl::Status makeLevel(int level, TerrainStages& stages) {
        const auto tiles =
            static_cast<std::uint32_t>(pyramid().tilesX(level) * pyramid().tilesY(level));
        for (std::uint32_t first = 0; first < tiles; first += kTilesAtOnce) {
            RETURN_IF_ERROR(control_.check());
            const Batch batch{level, first, std::min(first + kTilesAtOnce, tiles)};
            RETURN_IF_ERROR(stages.run([&] { return makeBatch(batch); },
                                       {[&] { return stateOf(batch); },
                                        [&](const auto& state) { return restore(batch, state); }}));
        }
        return absl::OkStatus();
    }

    absl::Status makeBatch(const Batch& batch) {
        std::uint32_t next = batch.first;
        runTiles([&] { return next < batch.end ? begin(idOf(batch.level, next++)) : nullptr; },
                 [&](Tile& tile) { make(tile); }, [&](const Tile& tile) { write(tile); });
        RETURN_IF_ERROR(readStatus_);
        return writeStatus_;
    }

    /// What is known after a batch, and in it of all tiles before.
    struct Known {
        std::uint64_t pictures = 0;  ///< NamedPictures::stamp
        std::uint64_t lossSquares = 0;
        std::uint64_t covered = 0;
    };

    /// Known, and then the records of the batch's tiles.
    std::vector<std::byte> stateOf(const Batch& batch) const {
        std::vector<terrain::PageRecord> tiles;
        for (std::uint32_t number = batch.first; number < batch.end; ++number)
            tiles.push_back(imagery_.tiles[pyramid().tileIndex(idOf(batch.level, number))]);
        const Known known{pictures_.stamp, lossSquares_, covered_};
        const std::size_t tilesBytes = tiles.size() * sizeof(terrain::PageRecord);
        std::vector<std::byte> state(sizeof known + tilesBytes);
        std::memcpy(state.data(), &known, sizeof known);
        std::memcpy(state.data() + sizeof known, tiles.data(), tilesBytes);
        return state;
    }

    /// False, with nothing changed, where it is of other pictures or the tiles are not in the file.
    bool restore(const Batch& batch, std::span<const std::byte> state) {
        Known known;
        std::vector<terrain::PageRecord> tiles(batch.end - batch.first);
        const std::size_t tilesBytes = tiles.size() * sizeof(terrain::PageRecord);
        if (state.size() != sizeof known + tilesBytes)
            return false;
        std::memcpy(&known, state.data(), sizeof known);
        std::memcpy(tiles.data(), state.data() + sizeof known, tilesBytes);
        if (known.pictures != pictures_.stamp || !writer_.takeWritten(tiles))
            return false;
        for (std::size_t k = 0; k < tiles.size(); ++k)
            imagery_.tiles[pyramid().tileIndex(
                idOf(batch.level, batch.first + static_cast<std::uint32_t>(k)))] = tiles[k];
        lossSquares_ = known.lossSquares;
        covered_ = known.covered;
        written_ += static_cast<std::uint32_t>(tiles.size());
        return true;
    }

    TextureId idOf(int level, std::uint32_t number) const {
        const auto across = static_cast<std::uint32_t>(pyramid().tilesX(level));
        const auto down = static_cast<std::uint32_t>(pyramid().tilesY(level));
        const std::uint32_t row = number / across;
        return {level, static_cast<std::int32_t>(number % across),
                static_cast<std::int32_t>(source_.isLastRowFirst() ? down - 1 - row : row)};
    }

    /// A tile with its texels where they come from the pictures; null when there is no going on.
    TilePointer begin(const TextureId& id) {
        if (hasFailed_)
            return nullptr;
        readStatus_ = scratch_.status();
        if (readStatus_.ok())
            readStatus_ = control_.check();
        if (!readStatus_.ok())
            return nullptr;
        auto tile = std::make_shared<Tile>(id, pyramid());
        if (isInParts(*tile) || (id.level == 0 && !source_.mayHave(tile->rect)))
            return tile;
        tile->makeRoom();
        if (id.level == 0)
            readStatus_ = source_.read(tile->rect, tile->texels);
        return readStatus_.ok() ? tile : nullptr;
    }

    bool isInParts(const Tile& tile) const { return parts_ != nullptr && tile.id.level == 0; }

    void make(Tile& tile) const {
        if (isInParts(tile))
            take(tile);
        else
            build(tile);
        if (tile.status.ok() && tile.id != pyramid().top())
            store_.write(tile.id, std::exchange(tile.made.half, {}));
    }

    void take(Tile& tile) const {
        const std::size_t half =
            tile.id == pyramid().top() ? 0 : OwnTexels(tile, pyramid()).halfTexels();
        absl::StatusOr<TexturePiece> piece =
            parts_->readTexture(pyramid().tileIndex(tile.id), half);
        tile.status = piece.status();
        if (piece.ok())
            tile.made = *std::move(piece);
    }

    void build(Tile& tile) const {
        if (tile.id.level > 0)
            store_.read(tile.id.level, tile.rect, tile.texels);
        finish(tile, pyramid());
    }

    void write(const Tile& tile) {
        if (hasFailed_)
            return;
        using Record = absl::StatusOr<terrain::PageRecord>;
        const Record record =
            tile.status.ok() ? writer_.addPage(tile.made.page) : Record(tile.status);
        if (!record.ok()) {
            writeStatus_ = record.status();
            hasFailed_ = true;
            return;
        }
        imagery_.tiles[pyramid().tileIndex(tile.id)] = *record;
        lossSquares_ += tile.made.lossSquares;
        covered_ += tile.made.coveredTexels;
        control_.report("imagery", static_cast<double>(++written_) / pyramid().tileCount());
    }

    ImagerySource& source_;
    const NamedPictures& pictures_;
    const PartSet* parts_;
    TexelStore& store_;
    const terrain::Scratch& scratch_;
    const ImportControl& control_;
    terrain::EytWriter& writer_;
    terrain::ImageryIndex imagery_;
    std::uint64_t lossSquares_ = 0;
    std::uint64_t covered_ = 0;
    std::uint32_t written_ = 0;
    absl::Status readStatus_;   // by the first stage
    absl::Status writeStatus_;  // by the last stage
    std::atomic<bool> hasFailed_ = false;
};

}  // namespace

absl::StatusOr<terrain::ImageryIndex> buildImagery(
    ImagerySource& source, const NamedPictures& pictures, const PartSet* parts, TexelStore& store,
    const terrain::Scratch& scratch, const ImportControl& control, TerrainStages& stages,
    terrain::EytWriter& writer) {
    ASSIGN_OR_RETURN(
        terrain::ImageryIndex imagery,
        ImageryLine(source, pictures, parts, store, scratch, control, writer).run(stages));
    RETURN_IF_ERROR(scratch.status());
    return imagery;
}

absl::Status buildTextures(ImagerySource& source, const std::vector<std::uint32_t>& textures,
                           const ImportControl& control, const TextureSink& sink) {
    const terrain::TexturePyramid& pyramid = source.pyramid();
    std::vector<std::size_t> order(textures.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (source.isLastRowFirst())
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return pyramid.tileOf(textures[a]).y > pyramid.tileOf(textures[b]).y;
        });
    absl::Status readStatus;
    absl::Status sinkStatus;
    std::atomic<bool> hasFailed = false;
    std::size_t begun = 0;
    std::size_t ended = 0;
    const auto begin = [&]() -> TilePointer {
        readStatus = control.check();
        if (begun == order.size() || hasFailed || !readStatus.ok())
            return nullptr;
        auto tile = std::make_shared<Tile>(pyramid.tileOf(textures[order[begun++]]), pyramid);
        if (!source.mayHave(tile->rect))
            return tile;
        tile->makeRoom();
        readStatus = source.read(tile->rect, tile->texels);
        return readStatus.ok() ? tile : nullptr;
    };
    const auto end = [&](const Tile& tile) {
        if (sinkStatus.ok())
            sinkStatus = sink(order[ended], tile.made);
        hasFailed = !sinkStatus.ok();
        ++ended;
        control.report("imagery", static_cast<double>(ended) / static_cast<double>(order.size()));
    };
    runTiles(
        begin, [&](Tile& tile) { finish(tile, pyramid); }, end);
    RETURN_IF_ERROR(readStatus);
    return sinkStatus;
}

}  // namespace eyrie::import
