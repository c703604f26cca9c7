// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/eyt_writer.h"

#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/name_beside.h"
#include "fabric/partial_file.h"
#include "fabric/replaceable.h"
#include "fabric/status.h"
#include "fabric/writer_lock.h"
#include "renderer/terrain/eyt_layout.h"
#include "renderer/terrain/normal_map.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::terrain {
namespace {

/// The index's bytes: CRS, tiles, pages, imagery.
std::vector<char> indexBytes(const EytIndex& index) {
    const std::uint64_t tilesOffset = roundUp(index.crsWkt.size(), 8);
    const std::uint64_t tilesBytes = index.tiles.size() * sizeof(TileRecord);
    const std::uint64_t pagesOffset = roundUp(tilesOffset + tilesBytes, 8);
    const std::uint64_t pagesBytes = index.pages.size() * sizeof(PageRecord);
    const std::vector<std::byte> imagery =
        index.imagery ? bytesOf(*index.imagery) : std::vector<std::byte>();
    std::vector<char> bytes(pagesOffset + pagesBytes + imagery.size());
    std::memcpy(bytes.data(), index.crsWkt.data(), index.crsWkt.size());
    std::memcpy(bytes.data() + tilesOffset, index.tiles.data(), tilesBytes);
    std::memcpy(bytes.data() + pagesOffset, index.pages.data(), pagesBytes);
    if (!imagery.empty())
        std::memcpy(bytes.data() + pagesOffset + pagesBytes, imagery.data(), imagery.size());
    return bytes;
}

FileHeader headerOf(const EytIndex& index, std::uint64_t indexOffset,
                    const std::vector<char>& bytes) {
    FileHeader header;
    header.levels = static_cast<std::uint32_t>(index.quadtree.levels());
    header.columns = static_cast<std::uint32_t>(index.quadtree.columns());
    header.rows = static_cast<std::uint32_t>(index.quadtree.rows());
    for (int k = 0; k < 16; ++k)
        header.objectFromLattice[static_cast<std::size_t>(k)] =
            index.objectFromLattice[k / 4][k % 4];
    header.sourceHash = index.sourceHash;
    header.nodataPosts = index.nodataPosts;
    header.indexOffset = indexOffset;
    header.indexBytes = bytes.size();
    header.crsBytes = index.crsWkt.size();
    header.indexChecksum = XXH64(bytes.data(), bytes.size(), 0);
    header.headerChecksum = XXH64(&header, offsetof(FileHeader, headerChecksum), 0);
    return header;
}

}  // namespace

void PageBuilder::add(int place, int level, const TileMesh& mesh,
                      std::span<const std::int8_t> normals) {
    assert(normals.empty() || normals.size() == normalMapBytes(level));
    header_.cells = static_cast<std::uint16_t>(Quadtree::cells(level));
    header_.finerStep = static_cast<std::uint16_t>(mesh.shape.finerStep);
    if (!mesh.indices.empty())
        addGeometry(place, mesh);
    if (normals.empty())
        return;
    header_.normalTiles |= 1U << place;
    normals_.add(header_.cells, normals);
}

void PageBuilder::addGeometry(int place, const TileMesh& mesh) {
    const HeightPacking heights = chooseHeightPacking(mesh.vertices);
    header_.tiles[static_cast<std::size_t>(place)] = {
        .baseHeight = heights.base,
        .vertices = static_cast<std::uint16_t>(mesh.vertices.size()),
        .triangles = static_cast<std::uint16_t>(mesh.indices.size() / 3),
        .limitX = static_cast<std::uint16_t>(mesh.shape.limitX),
        .limitY = static_cast<std::uint16_t>(mesh.shape.limitY),
        .finerEdges = mesh.shape.finerEdges,
        .wordsPerVertex = static_cast<std::uint8_t>(heights.wordsPerVertex),
        .heightShift = static_cast<std::uint8_t>(heights.shift),
        .isSparse = mesh.isSparse,
    };
    geometry_.add(mesh, heights.base, heights.shift);
    hasTriangles_ = true;
}

std::vector<std::uint32_t> PageBuilder::finish() {
    const bool hasNormals = header_.normalTiles != 0;
    if (!hasTriangles_ && !hasNormals)
        return {};
    const GeometryBits geometry = geometry_.finish();
    const std::vector<std::uint8_t> normals =
        hasNormals ? normals_.finish() : std::vector<std::uint8_t>();
    header_.wordBytes = static_cast<std::uint32_t>(geometry.words.size() * sizeof(std::uint16_t));
    header_.rawBytes = static_cast<std::uint32_t>(geometry.raw.size());
    header_.normalBytes = static_cast<std::uint32_t>(normals.size());
    const std::size_t bytes =
        sizeof header_ + header_.wordBytes + header_.rawBytes + header_.normalBytes;
    std::vector<std::uint32_t> page(roundUp(bytes, sizeof(std::uint32_t)) / sizeof(std::uint32_t));
    char* next = reinterpret_cast<char*>(page.data());
    const auto append = [&](const void* data, std::size_t size) {
        if (size > 0)  // an empty array has no place
            std::memcpy(next, data, size);
        next += size;
    };
    append(&header_, sizeof header_);
    append(geometry.words.data(), header_.wordBytes);
    append(geometry.raw.data(), header_.rawBytes);
    append(normals.data(), header_.normalBytes);
    header_ = {};
    hasTriangles_ = false;
    return page;
}

EytWriter::EytWriter(std::string path, std::string partialPath, int fd)
    : path_(std::move(path)),
      partialPath_(std::move(partialPath)),
      fd_(fd),
      size_(sizeof(FileHeader)) {}

EytWriter::EytWriter(EytWriter&& other) noexcept
    : path_(std::move(other.path_)),
      partialPath_(std::move(other.partialPath_)),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_),
      started_(other.started_),
      keepsUnfinished_(other.keepsUnfinished_) {}

EytWriter::~EytWriter() {
    if (fd_ < 0)
        return;
    if (!keepsUnfinished_)
        unlink(partialPath_.c_str());
    close(fd_);  // and its lock with it, when the name is gone
}

absl::StatusOr<EytWriter> EytWriter::create(const std::string& path) {
    RETURN_IF_ERROR(fabric::checkReplaceable(path));
    ASSIGN_OR_RETURN(fabric::PartialFile partial, fabric::createPartial(path));
    return EytWriter(path, std::move(partial.path), partial.fd);
}

absl::StatusOr<EytWriter> EytWriter::resume(const std::string& path) {
    RETURN_IF_ERROR(fabric::checkReplaceable(path));
    std::string partialPath = fabric::nameBeside(path, ".partial");
    // Never through a link: what that leads to is somebody else's.
    const int fd = open(partialPath.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (fd < 0)
        return fabric::writeError(partialPath, "cannot be written", errno);
    EytWriter writer(path, std::move(partialPath), fd);
    writer.keepsUnfinished_ = true;  // until it is known whose it is
    if (!fabric::mayWrite(fabric::takeWriterLock(writer.partialPath_, fd)))
        return absl::FailedPreconditionError(fmt::format(
            "{}: another import into the same file is at work; wait for it, or stop it", path));
    struct stat status {};
    writer.keepsUnfinished_ = fstat(fd, &status) == 0 && status.st_size > 0;
    return writer;
}

void EytWriter::removeUnfinished(const std::string& path) {
    const std::string partialPath = fabric::nameBeside(path, ".partial");
    const int fd = open(partialPath.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0)
        return;
    EytWriter writer(path, partialPath, fd);
    writer.keepsUnfinished_ = !fabric::mayWrite(fabric::takeWriterLock(partialPath, fd));
}

bool EytWriter::takeWritten(std::span<const PageRecord> pages) {
    std::uint64_t end = size_;
    std::vector<char> bytes;
    for (const PageRecord& page : pages) {
        if (page.bytes == 0)
            continue;
        if (page.offset != end)
            return false;
        bytes.resize(page.bytes);
        if (!readAt(bytes, page.offset) || XXH64(bytes.data(), bytes.size(), 0) != page.checksum)
            return false;
        end += page.bytes;
    }
    size_ = started_ = end;
    return true;
}

bool EytWriter::readAt(std::span<char> out, std::uint64_t offset) const {
    while (!out.empty()) {
        const ssize_t got = pread(fd_, out.data(), out.size(), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        out = out.subspan(static_cast<std::size_t>(got));
        offset += static_cast<std::uint64_t>(got);
    }
    return true;
}

absl::Status EytWriter::writeAt(const void* data, std::size_t bytes, std::uint64_t offset) {
    const char* next = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written = pwrite(fd_, next, bytes, static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return fabric::writeError(path_, "write failed", errno);
        next += written;
        bytes -= static_cast<std::size_t>(written);
        offset += static_cast<std::uint64_t>(written);
    }
    return absl::OkStatus();
}

absl::StatusOr<PageRecord> EytWriter::addPage(std::span<const std::uint32_t> page) {
    return addPage(std::as_bytes(page));
}

absl::StatusOr<PageRecord> EytWriter::addPage(std::span<const std::byte> page) {
    if (page.empty())
        return PageRecord{};
    const std::size_t bytes = page.size();
    const PageRecord record{size_, bytes, XXH64(page.data(), bytes, 0)};
    RETURN_IF_ERROR(writeAt(page.data(), bytes, size_));
    size_ += bytes;
    startDisk();
    return record;
}

/// Early, so that the flush at the end has little left to wait for; but not for each page, which
/// takes as long as writing it.
void EytWriter::startDisk() {
    constexpr std::uint64_t kAtOnce = 4 << 20;
    if (size_ < started_ + kAtOnce)
        return;
    sync_file_range(fd_, static_cast<off_t>(started_), static_cast<off_t>(size_ - started_),
                    SYNC_FILE_RANGE_WRITE);
    started_ = size_;
}

absl::StatusOr<std::uint64_t> EytWriter::commit(const EytIndex& index) {
    const std::vector<char> bytes = indexBytes(index);
    const std::uint64_t indexOffset = size_;
    const FileHeader header = headerOf(index, indexOffset, bytes);
    RETURN_IF_ERROR(writeAt(bytes.data(), bytes.size(), indexOffset));
    RETURN_IF_ERROR(writeAt(&header, sizeof header, 0));
    // An earlier writer may have left more.
    if (ftruncate(fd_, static_cast<off_t>(indexOffset + bytes.size())) != 0)
        return fabric::writeError(path_, "cannot be cut to its size", errno);
    if (fsync(fd_) != 0)
        return fabric::writeError(path_, "cannot be flushed to disk", errno);
    if (std::rename(partialPath_.c_str(), path_.c_str()) != 0)
        return fabric::writeError(path_, "cannot be renamed from its partial file", errno);
    close(std::exchange(fd_, -1));
    return indexOffset + bytes.size();
}

}  // namespace eyrie::terrain
