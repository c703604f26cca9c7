// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/eyt_format.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/terrain/eyt_layout.h"
#include "renderer/terrain/tile_triangulation.h"

namespace eyrie::terrain {
namespace {

/// Twice what 16 full tiles take that nothing shrinks: of a post, two flags and a height's symbol,
/// 4 bytes of its plain bits, and two symbols of a normal; a symbol takes a word at most.
constexpr std::uint64_t kMaxPageBytes = 8 << 20;
static_assert(kPageTiles * kPageTiles * kMaxTileVertices * (3 * 2 + 4 + 2 * 2) < kMaxPageBytes / 2);

constexpr const char* kRemedy = "import the elevation model again";

absl::Status corrupt(const std::string& name, const std::string& what) {
    return absl::DataLossError(fmt::format("{}: {}; {}", name, what, kRemedy));
}

/// Whether bytes [offset, offset + bytes) lie within the first `limit`.
bool fits(std::uint64_t offset, std::uint64_t bytes, std::uint64_t limit) {
    return offset <= limit && bytes <= limit - offset;
}

fabric::Mat4 matrixOf(const FileHeader& header) {
    fabric::Mat4 m(1.0);
    for (int k = 0; k < 16; ++k)
        m[k / 4][k % 4] = header.objectFromLattice[static_cast<std::size_t>(k)];
    return m;
}

bool isRightHandedAffine(const fabric::Mat4& m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row]))
                return false;
    return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1 && m[0][2] == 0 &&
           m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0 && m[2][2] > 0 &&
           glm::determinant(fabric::Mat3(m)) > 0;
}

absl::Status checkHeader(const FileHeader& header, std::uint64_t fileBytes,
                         const std::string& path) {
    if (header.magic != kEytMagic)
        return absl::InvalidArgumentError(fmt::format(
            "{}: is no .eyt terrain (its first bytes are not 'EYRIEEYT'); import a DEM first",
            path));
    if (header.version != kEytVersion)
        return absl::InvalidArgumentError(
            fmt::format("{}: header.version is {}, this build reads {}; {} with this version", path,
                        header.version, kEytVersion, kRemedy));
    if (header.headerChecksum != XXH64(&header, offsetof(FileHeader, headerChecksum), 0))
        return corrupt(path, "the checksum of the header is wrong");
    if (header.columns < 2 || header.rows < 2 || header.columns > kMaxPosts ||
        header.rows > kMaxPosts || std::uint64_t{header.columns} * header.rows > kMaxGridPosts)
        return corrupt(path, fmt::format("header.columns x rows is {} x {}, expected 2 to {} each",
                                         header.columns, header.rows, kMaxPosts));
    if (!isRightHandedAffine(matrixOf(header)))
        return corrupt(path, "header.objectFromLattice is not a right-handed affine transform");
    if (!fits(header.indexOffset, header.indexBytes, fileBytes))
        return corrupt(path,
                       fmt::format("header.indexOffset {} and indexBytes {} pass the end at {}",
                                   header.indexOffset, header.indexBytes, fileBytes));
    return absl::OkStatus();
}

absl::Status checkTile(const TileRecord& tile, const std::string& path, std::size_t number) {
    if (std::isfinite(tile.errorMetres) && tile.errorMetres >= 0 &&
        std::isfinite(tile.outlineMetres) && tile.outlineMetres >= 0 &&
        std::isfinite(tile.minHeightMetres) && std::isfinite(tile.maxHeightMetres) &&
        tile.minHeightMetres <= tile.maxHeightMetres)
        return absl::OkStatus();
    return corrupt(path,
                   fmt::format("tile {}: errors {} and {} m or heights {} to {} m are impossible",
                               number, tile.errorMetres, tile.outlineMetres, tile.minHeightMetres,
                               tile.maxHeightMetres));
}

/// No index of so many tiles is larger.
std::uint64_t mostIndexBytes(const Quadtree& quadtree) {
    constexpr std::uint64_t kHeadersAndPadding = 1024;
    constexpr std::uint64_t kTextures = 2 * kMaxTextureTiles;  // with those of coarser levels
    return kHeadersAndPadding + kMaxCrsBytes +
           std::uint64_t{quadtree.tileCount()} * sizeof(TileRecord) +
           (std::uint64_t{quadtree.pageCount()} + kTextures) * sizeof(PageRecord);
}

/// Where what lies in an index. Only its imagery may not be there.
struct IndexPlaces {
    IndexPlaces(const FileHeader& header, const Quadtree& quadtree)
        : tilesOffset(roundUp(header.crsBytes, 8)),
          tilesBytes(std::uint64_t{quadtree.tileCount()} * sizeof(TileRecord)),
          pagesOffset(roundUp(tilesOffset + tilesBytes, 8)),
          pagesBytes(std::uint64_t{quadtree.pageCount()} * sizeof(PageRecord)),
          pagesEnd(pagesOffset + pagesBytes),
          records(roundUp(header.indexBytes, sizeof(TileRecord)) / sizeof(TileRecord)) {}

    std::uint64_t tilesOffset;
    std::uint64_t tilesBytes;
    std::uint64_t pagesOffset;
    std::uint64_t pagesBytes;
    std::uint64_t pagesEnd;
    std::uint64_t records;  ///< as many tiles as take up what the index does
};

absl::Status checkIndexBytes(const FileHeader& header, const IndexPlaces& places,
                             const Quadtree& quadtree, const std::string& path) {
    if (header.indexBytes > mostIndexBytes(quadtree))
        return corrupt(path, fmt::format("header.indexBytes is {}, expected {} at most for {} x {} "
                                         "posts",
                                         header.indexBytes, mostIndexBytes(quadtree),
                                         header.columns, header.rows));
    if (header.crsBytes > kMaxCrsBytes || places.pagesEnd > header.indexBytes)
        return corrupt(path, fmt::format("header.indexBytes is {}, expected {} at least",
                                         header.indexBytes, places.pagesEnd));
    return absl::OkStatus();
}

absl::Status checkRecords(const FileHeader& header, const EytIndex& index,
                          const std::string& path) {
    for (std::size_t k = 0; k < index.tiles.size(); ++k)
        RETURN_IF_ERROR(checkTile(index.tiles[k], path, k));
    for (std::size_t k = 0; k < index.pages.size(); ++k) {
        const PageRecord& page = index.pages[k];
        const bool isPage = page.bytes >= sizeof(PageHeader) && page.bytes <= kMaxPageBytes &&
                            page.bytes % 4 == 0 && page.offset >= sizeof(FileHeader) &&
                            fits(page.offset, page.bytes, header.indexOffset);
        if (page.bytes != 0 && !isPage)
            return corrupt(path, fmt::format("page {}: {} bytes at {} are too many, or do not lie "
                                             "among the pages",
                                             k, page.bytes, page.offset));
    }
    return absl::OkStatus();
}

/// Reads CRS, tiles, pages and imagery. The bytes lie where the tiles will, which are most of
/// them: an index is never in memory twice.
absl::Status readIndex(const FileHeader& header, const IndexPlaces& places,
                       const page::PageSource& source, EytIndex& index) {
    index.tiles.resize(places.records);
    const std::span<std::byte> bytes =
        std::as_writable_bytes(std::span(index.tiles)).first(header.indexBytes);
    RETURN_IF_ERROR(source.read({header.indexOffset, header.indexBytes, header.indexChecksum},
                                bytes, "the index"));
    index.crsWkt.assign(reinterpret_cast<const char*>(bytes.data()), header.crsBytes);
    index.pages.resize(index.quadtree.pageCount());
    std::memcpy(index.pages.data(), bytes.data() + places.pagesOffset, places.pagesBytes);
    if (places.pagesEnd < bytes.size()) {
        ASSIGN_OR_RETURN(index.imagery, imageryFrom(bytes.subspan(places.pagesEnd), index.quadtree,
                                                    header.indexOffset, source.name()));
    }
    std::memmove(bytes.data(), bytes.data() + places.tilesOffset, places.tilesBytes);
    index.tiles.resize(index.quadtree.tileCount());
    return checkRecords(header, index, source.name());
}

/// Whether each tile of the page has the triangles and normals that the index says.
absl::Status checkAgainstIndex(const Page& page, std::uint32_t number, const EytIndex& index,
                               const std::string& name) {
    const TileId first = index.quadtree.firstTileOfPage(number);
    for (int place = 0; place < kPageTiles * kPageTiles; ++place) {
        const TileId id{first.level, first.x + place % kPageTiles, first.y + place / kPageTiles};
        const std::uint32_t expected = index.quadtree.contains(id) ? index.tile(id).triangles : 0;
        const TileGeometry& tile = page.tile(place);
        if (tile.cells != 0 && tile.cells != Quadtree::cells(first.level))
            return corrupt(name, fmt::format("tile {} has {} cells a side, its level has {}", place,
                                             tile.cells, Quadtree::cells(first.level)));
        const bool hasNormals = !tile.normals.empty();
        const bool isThere = index.quadtree.contains(id);
        if (hasNormals && !(isThere && id.level >= index.quadtree.normalLevel()))
            return corrupt(name, fmt::format("tile {} has normals, its level has none", place));
        if (!hasNormals && isThere && index.hasNormals(id))
            return corrupt(name, fmt::format("tile {} has no normals", place));
        const std::uint32_t found = tile.parts[kFinerPart].first / 3;
        if (found != expected)
            return corrupt(name, fmt::format("tile {} has {} triangles, the index says {}", place,
                                             found, expected));
    }
    return absl::OkStatus();
}

}  // namespace

double TileRecord::errorMetresOf(int x, int y, int count) const {
    int greatest = 0;
    for (int v = y; v < y + count; ++v)
        for (int u = x; u < x + count; ++u) greatest = std::max(greatest, partError(u, v));
    return static_cast<double>(errorMetres) * greatest / kFullPartError;
}

bool TileRecord::hasNodataIn(int x, int y, int count) const {
    const int row = (1 << count) - 1;
    int square = 0;
    for (int v = y; v < y + count; ++v) square |= row << (kTilePartsPerSide * v + x);
    return (nodataParts & square) != 0;
}

void TileRecord::coverErrorsOf(int child, const TileRecord& record) {
    const TileRecord own = *this;
    errorMetres = std::max(errorMetres, record.errorMetres);
    outlineMetres = std::max(outlineMetres, record.outlineMetres);
    for (int y = 0; y < kTilePartsPerSide; ++y) {
        int shares = 0;
        for (int x = 0; x < kTilePartsPerSide; ++x) {
            double error = own.errorMetresOf(x, y, 1);
            if (x / 2 == (child & 1) && y / 2 == child >> 1) {
                error = std::max(error, record.errorMetresOf(x % 2 * 2, y % 2 * 2, 2));
                if (record.hasNodataIn(x % 2 * 2, y % 2 * 2, 2))
                    nodataParts =
                        static_cast<std::uint16_t>(nodataParts | 1 << (kTilePartsPerSide * y + x));
            }
            shares |= partShare(error, errorMetres) << 4 * x;
        }
        partErrors[static_cast<std::size_t>(y)] = static_cast<std::uint16_t>(shares);
    }
}

int partShare(double partMetres, double errorMetres) {
    const double share = partMetres > 0 ? kFullPartError * (partMetres / errorMetres) : 0;
    // Rounded up, but for what computing a share of a share has added.
    return static_cast<int>(std::min(std::ceil(share * (1 - 1e-12)), double{kFullPartError}));
}

bool EytIndex::hasNormals(const TileId& id) const {
    if (id.level < quadtree.normalLevel())
        return false;
    if (tile(id).triangles > 0 || id.level > quadtree.normalLevel())
        return tile(id).triangles > 0;
    for (int level = 0; level < id.level; ++level) {
        const std::int32_t across = 1 << (id.level - level);
        for (std::int32_t k = 0; k < across * across; ++k)
            if (const TileId finer{level, id.x * across + k % across, id.y * across + k / across};
                quadtree.contains(finer) && tile(finer).triangles > 0)
                return true;
    }
    return false;
}

fabric::Box EytIndex::bounds(const TileId& id) const {
    const std::int32_t side = Quadtree::side(id.level);
    const double i0 = id.x * side;
    const double j0 = id.y * side;
    const double i1 = std::min(id.x * side + side, quadtree.columns() - 1);
    const double j1 = std::min(id.y * side + side, quadtree.rows() - 1);
    const TileRecord& record = tile(id);
    fabric::Box box;
    for (const double i : {i0, i1})
        for (const double j : {j0, j1}) {
            const fabric::Vec3 corner(objectFromLattice * fabric::Vec4(i, j, 0, 1));
            box.grow({corner.x, corner.y, record.minHeightMetres});
            box.grow({corner.x, corner.y, record.maxHeightMetres});
        }
    return box;
}

double EytIndex::finestErrorMetres() const {
    float worst = 0;
    const auto count =
        static_cast<std::size_t>(quadtree.tilesX(0)) * static_cast<std::size_t>(quadtree.tilesY(0));
    for (std::size_t k = 0; k < count; ++k) worst = std::max(worst, tiles[k].greatestErrorMetres());
    return worst;
}

std::uint64_t EytIndex::triangles() const {
    std::uint64_t sum = 0;
    const auto count =
        static_cast<std::size_t>(quadtree.tilesX(0)) * static_cast<std::size_t>(quadtree.tilesY(0));
    for (std::size_t k = 0; k < count; ++k) sum += tiles[k].triangles;
    return sum;
}

absl::StatusOr<std::shared_ptr<const EytFile>> EytFile::open(const std::string& path,
                                                             const page::SourceOptions& options,
                                                             std::uint64_t mostMemoryBytes) {
    FileHeader header;
    ASSIGN_OR_RETURN(std::unique_ptr<page::PageSource> source,
                     page::PageSource::open(path, sizeof header, options));
    const std::shared_ptr<EytFile> file(new EytFile(std::move(source)));
    const std::span<const std::byte> head = file->source_->head();
    if (head.size() < sizeof header)
        return absl::InvalidArgumentError(
            fmt::format("{}: is no .eyt terrain: {} bytes are too few for its header of {}", path,
                        file->sizeBytes(), sizeof header));
    std::memcpy(static_cast<void*>(&header), head.data(), sizeof header);
    RETURN_IF_ERROR(checkHeader(header, file->sizeBytes(), path));

    file->checksum_ = header.headerChecksum;
    EytIndex& index = file->index_;
    index.quadtree = Quadtree(header.columns, header.rows);
    if (static_cast<int>(header.levels) != index.quadtree.levels())
        return corrupt(path, fmt::format("header.levels is {}, expected {}", header.levels,
                                         index.quadtree.levels()));
    index.objectFromLattice = matrixOf(header);
    index.sourceHash = header.sourceHash;
    index.nodataPosts = header.nodataPosts;
    const IndexPlaces places(header, index.quadtree);
    RETURN_IF_ERROR(checkIndexBytes(header, places, index.quadtree, path));
    file->indexMemoryBytes_ = places.records * sizeof(TileRecord) + places.pagesBytes +
                              recordBytes(header.indexBytes - places.pagesEnd);
    if (file->indexMemoryBytes_ > mostMemoryBytes)
        return absl::ResourceExhaustedError(
            fmt::format("{}: its index takes {} bytes of memory, {} are left", path,
                        file->indexMemoryBytes_, mostMemoryBytes));
    try {
        RETURN_IF_ERROR(readIndex(header, places, *file->source_, index));
    } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError(
            fmt::format("{}: its index takes {} bytes of memory, which cannot be had", path,
                        file->indexMemoryBytes_));
    }
    return file;
}

absl::StatusOr<std::vector<std::uint32_t>> EytFile::readPageBytes(std::uint32_t page) const {
    const PageRecord& record = index_.pages[page];
    std::vector<std::uint32_t> bytes(record.bytes / 4);
    if (record.bytes != 0)
        RETURN_IF_ERROR(source_->read({record.offset, record.bytes, record.checksum},
                                      std::as_writable_bytes(std::span(bytes)),
                                      fmt::format("page {}", page)));
    return bytes;
}

absl::StatusOr<std::shared_ptr<const Page>> EytFile::readPage(std::uint32_t page,
                                                              PageForm form) const {
    ASSIGN_OR_RETURN(const std::vector<std::uint32_t> bytes, readPageBytes(page));
    const std::string place = fmt::format("{}: page {}", path(), page);
    ASSIGN_OR_RETURN(Page decoded, Page::decode(bytes, place, form));
    RETURN_IF_ERROR(checkAgainstIndex(decoded, page, index_, place));
    return std::make_shared<const Page>(std::move(decoded));
}

absl::StatusOr<std::shared_ptr<const TexturePage>> EytFile::readTexture(
    const TextureId& tile) const {
    const ImageryIndex& imagery = *index_.imagery;
    const PageRecord& record = imagery.tiles[imagery.pyramid.tileIndex(tile)];
    const std::string name = fmt::format("texture tile {}/{}/{}", tile.level, tile.x, tile.y);
    std::vector<std::byte> bytes(record.bytes);
    RETURN_IF_ERROR(source_->read({record.offset, record.bytes, record.checksum}, bytes, name));
    ASSIGN_OR_RETURN(TexturePage decoded, TexturePage::decode(bytes, imagery.pyramid.blocksX(tile),
                                                              imagery.pyramid.blocksY(tile),
                                                              fmt::format("{}: {}", path(), name)));
    return std::make_shared<const TexturePage>(std::move(decoded));
}

}  // namespace eyrie::terrain
