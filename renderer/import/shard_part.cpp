// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/shard_part.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <type_traits>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/name_beside.h"
#include "fabric/status.h"
#include "fabric/version.h"
#include "renderer/terrain/tiled_raster.h"

namespace eyrie::import {
namespace {

using terrain::PageRecord;

/// How a part begins; its pieces follow, then the table: a PageRecord for each.
struct Header {
    std::array<char, 8> magic = {'E', 'Y', 'R', 'I', 'E', 'P', 'R', 'T'};
    std::uint64_t format = 3;
    PartIdentity identity;
    std::uint64_t shard = 0;
    float minHeight = 0;
    float maxHeight = 0;
    std::uint64_t nodataPosts = 0;
    std::uint64_t allIntegers = 0;
    std::uint64_t tiles = 0;
    std::uint64_t pages = 0;
    std::uint64_t textures = 0;
    std::uint64_t tableOffset = 0;
    std::uint64_t tableChecksum = 0;
    std::uint64_t headerChecksum = 0;
};
static_assert(sizeof(PartIdentity) == 104 && sizeof(Header) == 200, "no padding");
static_assert(std::is_trivially_copyable_v<terrain::TileRecord>);

constexpr std::size_t kHeightsBytes = terrain::kRasterTileValues * sizeof(float);
constexpr std::size_t kMeasuredBytes = terrain::kRasterTileValues;

/// How a texture's piece begins; the half's texels follow, then the page.
struct TextureHeader {
    std::uint64_t lossSquares = 0;
    std::uint64_t coveredTexels = 0;
    std::uint64_t halfTexels = 0;
};

std::uint64_t checksumOf(const Header& header) {
    return XXH64(&header, offsetof(Header, headerChecksum), 0);
}

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

std::size_t placeOf(const std::vector<std::uint32_t>& ascending, std::uint32_t value) {
    const auto found = std::lower_bound(ascending.begin(), ascending.end(), value);
    assert(found != ascending.end() && *found == value);
    return static_cast<std::size_t>(found - ascending.begin());
}

std::string_view versionOf(const PartIdentity& identity) {
    const char* const text = identity.programVersion.data();
    return {text, strnlen(text, identity.programVersion.size())};
}

}  // namespace

PartIdentity identityOf(const terrain::GridFrame& frame, std::uint64_t sourceHash,
                        double errorMetres, std::uint64_t pictures, std::uint32_t shards) {
    PartIdentity identity;
    fabric::kVersion.copy(identity.programVersion.data(), identity.programVersion.size());
    identity.sourceHash = sourceHash;
    identity.pictures = pictures;
    identity.columns = frame.columns;
    identity.rows = frame.rows;
    identity.frame = {frame.origin.x,    frame.origin.y, frame.perColumn.x,
                      frame.perColumn.y, frame.perRow.x, frame.perRow.y};
    identity.errorMetres = errorMetres;
    identity.shards = shards;
    return identity;
}

std::string difference(const PartIdentity& found, const PartIdentity& expected) {
    const auto option = [](double metres) {
        return metres < 0 ? std::string("no --error") : fmt::format("--error {}", metres);
    };
    if (found.programVersion != expected.programVersion)
        return fmt::format("made by eyrie {}, this is {}", versionOf(found), versionOf(expected));
    if (found.shards != expected.shards)
        return fmt::format("one of {} shards, not of {}", found.shards, expected.shards);
    if (found.errorMetres != expected.errorMetres)
        return fmt::format("made with {}, now it is {}", option(found.errorMetres),
                           option(expected.errorMetres));
    if (found.columns != expected.columns || found.rows != expected.rows)
        return fmt::format("made from sources of {} x {} posts, these have {} x {}", found.columns,
                           found.rows, expected.columns, expected.rows);
    if (found.frame != expected.frame)
        return "made from sources whose posts stand elsewhere";
    if (found.sourceHash != expected.sourceHash)
        return fmt::format(
            "made from other sources, or the same in another order: their "
            "checksum was {:016x}, now it is {:016x}",
            found.sourceHash, expected.sourceHash);
    if (found.pictures != expected.pictures)
        return found.pictures == 0      ? "made without --imagery"
               : expected.pictures == 0 ? "made with --imagery"
                                        : "made with other pictures, or the same in another order";
    return "";
}

std::string partsFolder(const std::string& out) { return fabric::nameBeside(out, ".parts"); }

std::string partPath(const std::string& out, const Shard& shard) {
    return fmt::format("{}/shard-{}-of-{}", partsFolder(out), shard.index, shard.count);
}

std::string factsPath(const std::string& out, const Shard& shard) {
    return fmt::format("{}/facts-{}-of-{}", partsFolder(out), shard.index, shard.count);
}

PartWriter::PartWriter(WholeFile file, const PartIdentity& identity, const Shard& shard,
                       const terrain::HeightStatistics& statistics)
    : file_(std::move(file)), identity_(identity), shard_(shard), statistics_(statistics) {}

absl::StatusOr<PartWriter> PartWriter::create(const std::string& path, const PartIdentity& identity,
                                              const Shard& shard,
                                              const terrain::HeightStatistics& statistics) {
    ASSIGN_OR_RETURN(WholeFile file, WholeFile::create(path));
    const Header empty{};
    RETURN_IF_ERROR(file.append(std::as_bytes(std::span(&empty, 1))));
    return PartWriter(std::move(file), identity, shard, statistics);
}

absl::StatusOr<PageRecord> PartWriter::append(std::span<const std::byte> bytes) {
    const PageRecord record{file_.sizeBytes(), bytes.size(), XXH64(bytes.data(), bytes.size(), 0)};
    RETURN_IF_ERROR(file_.append(bytes));
    return record;
}

absl::Status PartWriter::add(std::span<const std::byte> bytes) {
    ASSIGN_OR_RETURN(const PageRecord record, append(bytes));
    table_.push_back(record);
    return absl::OkStatus();
}

absl::Status PartWriter::addTile(const float* heights, const std::uint8_t* measured) {
    ++tiles_;
    RETURN_IF_ERROR(add(std::as_bytes(std::span(heights, terrain::kRasterTileValues))));
    return add(std::as_bytes(std::span(measured, terrain::kRasterTileValues)));
}

absl::Status PartWriter::addPage(const PageTiles& tiles, std::span<const std::uint32_t> page) {
    ++pages_;
    std::vector<std::byte> bytes(sizeof tiles + page.size_bytes());
    std::memcpy(bytes.data(), tiles.data(), sizeof tiles);
    if (!page.empty())
        std::memcpy(bytes.data() + sizeof tiles, page.data(), page.size_bytes());
    return add(bytes);
}

absl::Status PartWriter::addTexture(std::size_t k, const TexturePiece& texture) {
    const TextureHeader header{texture.lossSquares, texture.coveredTexels, texture.half.size()};
    const std::span<const std::byte> half = bytesOf(texture.half);
    std::vector<std::byte> bytes(sizeof header);
    std::memcpy(bytes.data(), &header, sizeof header);
    bytes.insert(bytes.end(), half.begin(), half.end());
    bytes.insert(bytes.end(), texture.page.begin(), texture.page.end());
    textures_.resize(std::max(textures_.size(), k + 1));
    ASSIGN_OR_RETURN(textures_[k], append(bytes));
    return absl::OkStatus();
}

absl::StatusOr<std::uint64_t> PartWriter::commit() {
    Header header;
    header.identity = identity_;
    header.shard = shard_.index;
    header.minHeight = statistics_.min;
    header.maxHeight = statistics_.max;
    header.nodataPosts = statistics_.nodataPosts;
    header.allIntegers = statistics_.allIntegers ? 1 : 0;
    header.tiles = tiles_;
    header.pages = pages_;
    header.textures = textures_.size();
    header.tableOffset = file_.sizeBytes();
    table_.insert(table_.end(), textures_.begin(), textures_.end());
    const std::span<const std::byte> table = bytesOf(table_);
    header.tableChecksum = XXH64(table.data(), table.size(), 0);
    header.headerChecksum = checksumOf(header);
    RETURN_IF_ERROR(file_.append(table));
    RETURN_IF_ERROR(file_.writeAt(0, std::as_bytes(std::span(&header, 1))));
    RETURN_IF_ERROR(file_.commit());
    return file_.sizeBytes();
}

PartFile::PartFile(std::string path, int fd, const Shard& shard)
    : path_(std::move(path)), fd_(fd), shard_(shard) {}

PartFile::PartFile(PartFile&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      shard_(other.shard_),
      size_(other.size_),
      statistics_(other.statistics_),
      tiles_(std::move(other.tiles_)),
      pages_(std::move(other.pages_)),
      textures_(std::move(other.textures_)),
      table_(std::move(other.table_)) {}

PartFile::~PartFile() {
    if (fd_ >= 0)
        close(fd_);
}

absl::Status PartFile::damaged(std::string_view what) const {
    return absl::DataLossError(fmt::format("{}: {}; run the import with --shard {}/{} again", path_,
                                           what, shard_.index, shard_.count));
}

absl::StatusOr<PartFile> PartFile::open(const std::string& path, const PartIdentity& identity,
                                        const Shard& shard, const ShardPlan& plan) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0 && errno == ENOENT)
        return absl::NotFoundError(fmt::format("{}: is missing; run the import with --shard {}/{}",
                                               path, shard.index, shard.count));
    if (fd < 0)
        return absl::UnavailableError(
            fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
    PartFile part(path, fd, shard);
    struct stat status {};
    if (fstat(fd, &status) == 0)
        part.size_ = static_cast<std::uint64_t>(status.st_size);
    RETURN_IF_ERROR(part.check(identity, plan));
    return part;
}

absl::Status PartFile::check(const PartIdentity& identity, const ShardPlan& plan) {
    Header header;
    const Header expected;
    if (size_ < sizeof header)
        return damaged("is cut short");
    if (pread(fd_, &header, sizeof header, 0) != static_cast<ssize_t>(sizeof header))
        return damaged("cannot be read");
    if (header.magic != expected.magic || header.format != expected.format)
        return absl::InvalidArgumentError(fmt::format(
            "{}: is no part that this build reads; run the import with --shard {}/{} again", path_,
            shard_.index, shard_.count));
    if (header.headerChecksum != checksumOf(header))
        return damaged("its header's checksum fails");
    if (const std::string found = difference(header.identity, identity); !found.empty())
        return absl::InvalidArgumentError(fmt::format(
            "{}: is {}; give all shards and the merge the same sources and options, or run the "
            "import with --shard {}/{} again",
            path_, found, shard_.index, shard_.count));
    tiles_ = plan.tilesOf(shard_.index);
    pages_ = plan.pagesOf(shard_.index);
    textures_ = plan.texturesOf(shard_.index);
    if (header.shard != shard_.index || header.tiles != tiles_.size() ||
        header.pages != pages_.size() || header.textures != textures_.size())
        return damaged("is the part of another shard");
    statistics_ = {header.minHeight, header.maxHeight, header.nodataPosts, header.allIntegers != 0};
    return readTable(header.tableOffset, header.tableChecksum);
}

absl::Status PartFile::readTable(std::uint64_t offset, std::uint64_t checksum) {
    const std::size_t firstTexture = 2 * tiles_.size() + pages_.size();
    const std::size_t entries = firstTexture + textures_.size();
    const std::uint64_t bytes = entries * sizeof(PageRecord);
    if (offset > size_ || bytes != size_ - offset)
        return damaged("is cut short");
    table_.resize(entries);
    RETURN_IF_ERROR(read({offset, bytes, checksum}, table_.data()));
    for (std::size_t k = 0; k < entries; ++k) {
        const PageRecord& piece = table_[k];
        const bool isPage = k >= 2 * tiles_.size();
        const bool isSize = k >= firstTexture ? piece.bytes >= sizeof(TextureHeader)
                            : isPage ? piece.bytes >= sizeof(PageTiles) && piece.bytes % 4 == 0
                                     : piece.bytes == (k % 2 == 0 ? kHeightsBytes : kMeasuredBytes);
        if (!isSize || piece.offset > offset || piece.bytes > offset - piece.offset)
            return damaged(fmt::format("piece {} of its table cannot be", k));
    }
    return absl::OkStatus();
}

absl::Status PartFile::read(const PageRecord& piece, void* out) const {
    std::size_t have = 0;
    while (have < piece.bytes) {
        const ssize_t got = pread(fd_, static_cast<char*>(out) + have, piece.bytes - have,
                                  static_cast<off_t>(piece.offset + have));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return absl::UnavailableError(
                fmt::format("{}: cannot be read: {}", path_, std::strerror(errno)));
        if (got == 0)
            return damaged("is cut short");
        have += static_cast<std::size_t>(got);
    }
    if (XXH64(out, piece.bytes, 0) != piece.checksum)
        return damaged(
            fmt::format("the checksum of {} bytes at {} fails", piece.bytes, piece.offset));
    return absl::OkStatus();
}

absl::Status PartFile::readHeights(std::uint32_t tile, float* out) const {
    return read(table_[2 * placeOf(tiles_, tile)], out);
}

absl::Status PartFile::readMeasured(std::uint32_t tile, std::uint8_t* out) const {
    return read(table_[2 * placeOf(tiles_, tile) + 1], out);
}

absl::StatusOr<std::vector<std::uint32_t>> PartFile::readPage(std::uint32_t page,
                                                              PageTiles& tiles) const {
    const PageRecord& piece = table_[2 * tiles_.size() + placeOf(pages_, page)];
    std::vector<std::byte> bytes(piece.bytes);
    RETURN_IF_ERROR(read(piece, bytes.data()));
    std::memcpy(tiles.data(), bytes.data(), sizeof tiles);
    std::vector<std::uint32_t> words((piece.bytes - sizeof tiles) / sizeof(std::uint32_t));
    if (!words.empty())
        std::memcpy(words.data(), bytes.data() + sizeof tiles, bytes.size() - sizeof tiles);
    return words;
}

absl::StatusOr<TexturePiece> PartFile::readTexture(std::uint32_t texture,
                                                   std::size_t halfTexels) const {
    const PageRecord& piece =
        table_[2 * tiles_.size() + pages_.size() + placeOf(textures_, texture)];
    std::vector<std::byte> bytes(piece.bytes);
    RETURN_IF_ERROR(read(piece, bytes.data()));
    TextureHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::uint64_t halfBytes = header.halfTexels * sizeof(fabric::Rgba);
    if ((header.halfTexels != halfTexels && header.halfTexels != 0) ||
        bytes.size() < sizeof header + halfBytes)
        return damaged(fmt::format("texture {} has the wrong size", texture));
    const std::byte* const half = bytes.data() + sizeof header;
    TexturePiece result{
        header.lossSquares, header.coveredTexels, std::vector<fabric::Rgba>(header.halfTexels),
        std::vector<std::byte>(half + halfBytes, half + bytes.size() - sizeof header)};
    if (halfBytes > 0)
        std::memcpy(result.half.data(), half, halfBytes);
    return result;
}

absl::Status PartFile::verify() const {
    std::vector<std::byte> bytes;
    for (const PageRecord& piece : table_) {
        bytes.resize(piece.bytes);
        RETURN_IF_ERROR(read(piece, bytes.data()));
    }
    return absl::OkStatus();
}

}  // namespace eyrie::import
