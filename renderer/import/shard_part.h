// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "fabric/image.h"
#include "renderer/import/shard_plan.h"
#include "renderer/import/whole_file.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/page_record.h"

namespace eyrie::import {

/// What the parts of one import have in common. Lies in files as it is.
struct PartIdentity {
    std::array<char, 16> programVersion{};
    std::uint64_t sourceHash = 0;
    std::uint64_t pictures = 0;  ///< pictureFingerprint; 0: none
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    std::array<double, 6> frame{};  ///< GridFrame's origin, perColumn, perRow
    double errorMetres = -1;        ///< of the option; -1: none
    std::uint64_t shards = 1;

    bool operator==(const PartIdentity&) const = default;
};
PartIdentity identityOf(const terrain::GridFrame& frame, std::uint64_t sourceHash,
                        double errorMetres, std::uint64_t pictures, std::uint32_t shards);

/// The first thing in which `found` is not what was expected, for a message; "" where all is.
std::string difference(const PartIdentity& found, const PartIdentity& expected);

/// `OUT.parts`, where the shards of an import into OUT leave their parts, and the names in it.
std::string partsFolder(const std::string& out);
std::string partPath(const std::string& out, const Shard& shard);
std::string factsPath(const std::string& out, const Shard& shard);

/// The records of a page's tiles by place; those of tiles that do not exist are of no meaning.
using PageTiles = std::array<terrain::TileRecord,
                             static_cast<std::size_t>(terrain::kPageTiles) * terrain::kPageTiles>;

/// A texture tile of level 0, made.
struct TexturePiece {
    std::uint64_t lossSquares = 0;    ///< summed squared differences of BC1, of covered texels
    std::uint64_t coveredTexels = 0;  ///< of its own
    std::vector<fabric::Rgba> half;   ///< what it becomes one level up; empty: nothing, or holes
    std::vector<std::byte> page;      ///< empty where all is a hole
};

/// Writes a part: first the tiles of ShardPlan::tilesOf, then the pages of pagesOf, each in their
/// order; then the tiles of texturesOf in any.
/// Errors: WholeFile's.
class PartWriter {
public:
    static absl::StatusOr<PartWriter> create(const std::string& path, const PartIdentity& identity,
                                             const Shard& shard,
                                             const terrain::HeightStatistics& statistics);

    /// Of a raster tile: kRasterTileValues heights, and what VertexLevels::measured says.
    absl::Status addTile(const float* heights, const std::uint8_t* measured);
    absl::Status addPage(const PageTiles& tiles, std::span<const std::uint32_t> page);

    /// `k`: the how manyth of texturesOf.
    absl::Status addTexture(std::size_t k, const TexturePiece& texture);

    /// Returns the file's size.
    absl::StatusOr<std::uint64_t> commit();

private:
    PartWriter(WholeFile file, const PartIdentity& identity, const Shard& shard,
               const terrain::HeightStatistics& statistics);
    absl::StatusOr<terrain::PageRecord> append(std::span<const std::byte> bytes);
    absl::Status add(std::span<const std::byte> bytes);

    WholeFile file_;
    PartIdentity identity_;
    Shard shard_;
    terrain::HeightStatistics statistics_;
    std::uint64_t tiles_ = 0;
    std::uint64_t pages_ = 0;
    std::vector<terrain::PageRecord> table_;  ///< heights and measured of each tile, then pages
    std::vector<terrain::PageRecord> textures_;
};

/// A part on disk. Any thread may read. Errors: NotFound; InvalidArgument (of another import, no
/// part at all); DataLoss (cut short, a checksum fails): all name the file and the remedy.
class PartFile {
public:
    /// Checks header and table.
    static absl::StatusOr<PartFile> open(const std::string& path, const PartIdentity& identity,
                                         const Shard& shard, const ShardPlan& plan);

    PartFile(PartFile&& other) noexcept;
    PartFile& operator=(PartFile&&) = delete;
    ~PartFile();

    /// Of all posts of the import, not of the part's alone.
    const terrain::HeightStatistics& statistics() const { return statistics_; }
    std::uint64_t sizeBytes() const { return size_; }
    const std::string& path() const { return path_; }

    /// Of the tile numbered y * tilesX + x. Precondition: it is the shard's own; the same of pages.
    absl::Status readHeights(std::uint32_t tile, float* out) const;
    absl::Status readMeasured(std::uint32_t tile, std::uint8_t* out) const;
    absl::StatusOr<std::vector<std::uint32_t>> readPage(std::uint32_t page, PageTiles& tiles) const;
    /// With as many texels one level up as `halfTexels` says, or none.
    absl::StatusOr<TexturePiece> readTexture(std::uint32_t texture, std::size_t halfTexels) const;

    /// Reads all there is.
    absl::Status verify() const;

private:
    PartFile(std::string path, int fd, const Shard& shard);
    absl::Status check(const PartIdentity& identity, const ShardPlan& plan);
    absl::Status readTable(std::uint64_t offset, std::uint64_t checksum);
    absl::Status read(const terrain::PageRecord& piece, void* out) const;
    absl::Status damaged(std::string_view what) const;

    std::string path_;
    int fd_;
    Shard shard_;
    std::uint64_t size_ = 0;
    terrain::HeightStatistics statistics_;
    std::vector<std::uint32_t> tiles_;
    std::vector<std::uint32_t> pages_;
    std::vector<std::uint32_t> textures_;
    std::vector<terrain::PageRecord> table_;
};

}  // namespace eyrie::import
