// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/box.h"
#include "fabric/vec.h"
#include "renderer/page/page_source.h"
#include "renderer/terrain/imagery/imagery_index.h"
#include "renderer/terrain/imagery/texture_page.h"
#include "renderer/terrain/page_record.h"
#include "renderer/terrain/quadtree.h"

/// The .eyt file: a terrain as a quadtree of triangulated tiles.
///
/// Everything drawn lies on one integer lattice per file: (i, j) are columns and rows of the source
/// grid's posts (j grows so that lattice and object space are both right-handed), q counts steps of
/// height. `objectFromLattice` turns that into metres of the file's CRS. The same post has the same
/// three integers in every tile of every level.
///
/// eyt_layout.h describes the bytes on disk; readers outside this folder need this header only.
namespace eyrie::terrain {

inline constexpr std::uint32_t kNoPage = 0xffffffff;

/// The share of the index list that belongs to one part of a tile, in indices (3 per triangle).
struct IndexRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;

    bool operator==(const IndexRange&) const = default;
};

/// Parts of a tile's index list, in the order in which they are stored: the interior, then each
/// edge's border triangles as this level draws them, then each edge's border triangles split up to
/// meet a neighbour that is one level finer. A tile is drawn as its interior and, for each edge,
/// exactly one of the two. `kOwnPart + edge`, `kFinerPart + edge`.
inline constexpr int kInteriorPart = 0;
inline constexpr int kOwnPart = 1;
inline constexpr int kFinerPart = 5;
inline constexpr int kTileParts = 9;

inline constexpr int kTilePartsPerSide = 4;  ///< of TileRecord::partErrors
inline constexpr int kFullPartError = 15;

/// A part's error as fifteenths of its tile's, rounded up.
int partShare(double partMetres, double errorMetres);

/// What is resident of every tile.
struct TileRecord {
    /// Vertical distance, at most, between what any form of the tile draws and the source: both
    /// diagonals of every cell and so the bilinear surface too, quantisation included. Of triangles
    /// without nodata. Not below that of any tile under it.
    float errorMetres = 0;
    /// How far the outline of a hole may be off, to any side: what OutlineError says of triangles,
    /// drawn or left out, that mix data and nodata. 0 where each post decides, as at the levels
    /// that draw every post. Not below that of any tile under it either.
    float outlineMetres = 0;
    float minHeightMetres = 0;  ///< of what is drawn and of the source
    float maxHeightMetres = 0;
    std::uint16_t triangles = 0;  ///< of interior and own borders; 0: nothing to draw
    /// Bit 4 * y + x of each of the tile's 4 x 4 parts in which data and nodata meet, however exact
    /// the outline. The source's posts in any other part are either all data or all nodata.
    std::uint16_t nodataParts = 0;
    /// errorMetres of each part in fifteenths of the tile's: a row of parts, from the lowest, four
    /// bits each.
    std::array<std::uint16_t, kTilePartsPerSide> partErrors = {0xffff, 0xffff, 0xffff, 0xffff};

    /// Of one part, in fifteenths.
    int partError(int x, int y) const {
        return partErrors[static_cast<std::size_t>(y)] >> 4 * x & 15;
    }
    // Over a square of parts, from (x, y) on, `count` a side:
    double errorMetresOf(int x, int y, int count) const;
    bool hasNodataIn(int x, int y, int count) const;
    /// Whether the outline of a hole there may be off. If not, the error is vertical and nothing
    /// else.
    bool blursOutlineIn(int x, int y, int count) const {
        return outlineMetres > 0 && hasNodataIn(x, y, count);
    }
    /// To any side.
    float greatestErrorMetres() const { return std::max(errorMetres, outlineMetres); }
    /// Raises the errors to those of child 0 to 3, and marks its parts.
    void coverErrorsOf(int child, const TileRecord& record);

    bool operator==(const TileRecord&) const = default;
};
static_assert(sizeof(TileRecord) == 28);

/// All of an .eyt file but its pages; always resident.
struct EytIndex {
    Quadtree quadtree;
    fabric::Mat4 objectFromLattice{1.0};  ///< affine, right-handed, metres; height on z alone
    std::string crsWkt;                   ///< empty: not georeferenced
    std::uint64_t sourceHash = 0;         ///< XXH64 of the bytes of the source file
    std::uint64_t nodataPosts = 0;
    std::vector<TileRecord> tiles;  ///< by quadtree.tileIndex
    std::vector<PageRecord> pages;  ///< by quadtree.pageIndex
    std::optional<ImageryIndex> imagery;

    const TileRecord& tile(const TileId& id) const { return tiles[quadtree.tileIndex(id)]; }
    /// Whether the tile's page has normals of it: it is drawn, or a tile that needs its normals is.
    bool hasNormals(const TileId& id) const;
    /// Metres of one step of q, and of q = 0.
    double heightStepMetres() const { return objectFromLattice[2][2]; }
    double heightOriginMetres() const { return objectFromLattice[3][2]; }
    /// Box around what is drawn and the source within a tile; object space, metres.
    fabric::Box bounds(const TileId& id) const;
    fabric::Box bounds() const { return bounds(quadtree.top()); }
    /// Error of the coarsest tile, and the largest of level 0.
    double coarsestErrorMetres() const { return tile(quadtree.top()).greatestErrorMetres(); }
    double finestErrorMetres() const;
    /// Of level 0.
    std::uint64_t triangles() const;
};

/// One tile as spans into its page: its geometry, which may be empty, and its normals.
///
/// Vertex n is `words[n * wordsPerVertex]`: bits 0-9 x and 10-19 y in half sample spacings (0 to
/// 2 * cells), bits 20-31 height; with two words a vertex the second is the height instead. So
/// always height = (word0 >> 20) + word1, word1 = 0 in the short form. The lattice point is
///   i = min(tile.x * Quadtree::side(level) + (x << Quadtree::spacingShift(level) >> 1), columns -
///   1), j alike with y and rows, q = baseHeight + height * heightMultiplier.
/// Triangles are counter-clockwise seen from above.
///
/// Of a page read as outlines, words and indices are empty, and `outline` is what they are made
/// from: codec/tile_outline.h.
struct TileGeometry {
    std::span<const std::uint32_t> words;
    int wordsPerVertex = 1;
    std::span<const std::uint16_t> indices;
    std::array<IndexRange, kTileParts> parts;  ///< one after the other, together all indices
    std::int32_t baseHeight = 0;               ///< q of height 0
    std::int32_t heightMultiplier = 1;         ///< a power of two
    std::int32_t cells = 0;                    ///< Quadtree::cells of its level
    /// x and y of the unit surface normal in object space (z > 0), signed normalised, interleaved:
    /// (cells + 1) squared, row by row from the tile's first post, one per sample of the level.
    /// Empty below Quadtree::normalLevel(); there without geometry where finer tiles need them.
    std::span<const std::int8_t> normals;
    std::span<const std::uint32_t> outline;
    std::uint32_t vertices = 0;  ///< of words, there or still to be made

    bool isEmpty() const { return indexCount() == 0; }
    std::size_t vertexCount() const { return vertices; }
    std::size_t indexCount() const { return parts.back().first + parts.back().count; }
    /// Of words and indices, there or still to be made.
    std::size_t wordBytes() const {
        return vertices * static_cast<std::size_t>(wordsPerVertex) * sizeof(std::uint32_t);
    }
    std::size_t indexBytes() const { return indexCount() * sizeof(std::uint16_t); }
};

/// How far a page's tiles are decoded.
enum class PageForm {
    Drawable,  ///< to vertices and indices
    Outlines,  ///< to what a device makes the same vertices and indices from
};

/// One page of tiles, decoded and checked. Owns its arrays; immutable, so shared freely between
/// threads.
class Page {
public:
    Page(Page&&) = default;
    Page& operator=(Page&&) = default;

    /// Decodes what PageBuilder made; of no bytes at all, a page without triangles. Whatever the
    /// bytes are, nothing leads out of bounds, and time and memory are bounded by what 16 full
    /// tiles take (6 MB). Errors: DataLoss. `name` is used in messages only.
    static absl::StatusOr<Page> decode(std::span<const std::uint32_t> bytes,
                                       const std::string& name, PageForm form = PageForm::Drawable);

    /// By Quadtree::placeInPage; its geometry is empty where there are no triangles.
    const TileGeometry& tile(int place) const { return tiles_[static_cast<std::size_t>(place)]; }
    /// Of memory; on disk a page is smaller.
    std::size_t sizeBytes() const { return storage_.size() * sizeof(std::uint32_t); }

private:
    Page() = default;

    std::vector<std::uint32_t> storage_;
    std::array<TileGeometry, kPageTiles * kPageTiles> tiles_;
};

/// An open .eyt file, here or elsewhere. Any thread may read pages at any time.
class EytFile {
public:
    /// Reads and checks header and index. `path` may be an address (page/remote_name.h). Errors:
    /// NotFound, InvalidArgument (not an .eyt, or a newer version), DataLoss (truncated, or a
    /// checksum fails); ResourceExhausted, before the index is read, where that would take more
    /// than `mostMemoryBytes` or than can be had; of an address PermissionDenied and Unavailable,
    /// too.
    static absl::StatusOr<std::shared_ptr<const EytFile>> open(
        const std::string& path, const page::SourceOptions& options = {},
        std::uint64_t mostMemoryBytes = std::numeric_limits<std::uint64_t>::max());

    EytFile(const EytFile&) = delete;
    EytFile& operator=(const EytFile&) = delete;

    const EytIndex& index() const { return index_; }
    const std::string& path() const { return source_->name(); }
    std::uint64_t sizeBytes() const { return source_->sizeBytes(); }
    /// What the index takes in memory, but for its CRS.
    std::uint64_t indexMemoryBytes() const { return indexMemoryBytes_; }
    /// Of the header, which holds the index's, which holds the pages': of all of the file.
    std::uint64_t checksum() const { return checksum_; }

    /// Reads one page; of an address, from the cache or in a bounded time (page/byte_source.h).
    /// Errors: DataLoss (checksum, or contents that contradict themselves or the index, or the
    /// file has changed on its server), Unavailable (read error), others of PageSource::read.
    /// Precondition: page < index().pages.size().
    absl::StatusOr<std::shared_ptr<const Page>> readPage(std::uint32_t page,
                                                         PageForm form = PageForm::Drawable) const;

    /// Its bytes as they lie in the file, for Page::decode; none of a page without triangles.
    /// Errors: those of PageSource::read. Same precondition.
    absl::StatusOr<std::vector<std::uint32_t>> readPageBytes(std::uint32_t page) const;

    /// The same of a texture tile. Precondition: index().imagery, which has the tile.
    absl::StatusOr<std::shared_ptr<const TexturePage>> readTexture(const TextureId& tile) const;

private:
    explicit EytFile(std::unique_ptr<page::PageSource> source) : source_(std::move(source)) {}

    std::unique_ptr<page::PageSource> source_;
    std::uint64_t checksum_ = 0;
    std::uint64_t indexMemoryBytes_ = 0;
    EytIndex index_;
};

}  // namespace eyrie::terrain
