// SPDX-License-Identifier: Apache-2.0
// .eyt files, whose header, index and pages are untrusted once their checksums are right.
//
// An input's first byte picks how it is read. 255 takes the rest for a file, whose checksums are
// put right. Otherwise each four bytes after it put the fourth at the offset that the first three
// name, in a real terrain's header (even) or index (odd): so inputs reach past the checks of sizes.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>
#include <xxhash.h>

#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_layout.h"

namespace {

using namespace eyrie;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kColumns = 300;
constexpr std::uint32_t kRows = 140;
constexpr std::uint32_t kPageBytes = 400;

template <typename Record>
void append(const std::vector<Record>& records, Bytes& bytes) {
    const auto* from = reinterpret_cast<const std::uint8_t*>(records.data());
    bytes.insert(bytes.end(), from, from + records.size() * sizeof(Record));
}

/// Header, a page of zeros, and the index of a flat terrain.
Bytes realFile() {
    const terrain::Quadtree quadtree(kColumns, kRows);
    terrain::FileHeader header;
    header.levels = static_cast<std::uint32_t>(quadtree.levels());
    header.columns = kColumns;
    header.rows = kRows;
    for (const std::size_t k : {0U, 5U, 10U, 15U}) header.objectFromLattice[k] = 1;
    header.crsBytes = 8;
    header.indexOffset = sizeof header + kPageBytes;
    const std::vector<char> crs(header.crsBytes, 'x');
    std::vector<terrain::TileRecord> tiles(quadtree.tileCount());
    for (terrain::TileRecord& tile : tiles) tile.maxHeightMetres = 1;
    std::vector<terrain::PageRecord> pages(quadtree.pageCount());
    const Bytes page(kPageBytes);
    pages[0].offset = sizeof header;
    pages[0].bytes = kPageBytes;
    pages[0].checksum = XXH64(page.data(), page.size(), 0);
    Bytes index;
    append(crs, index);
    append(tiles, index);
    index.resize(terrain::roundUp(index.size(), 8));
    append(pages, index);
    header.indexBytes = index.size();
    Bytes file(header.indexOffset + index.size());  // the page's bytes are zeros
    std::memcpy(file.data(), &header, sizeof header);
    std::memcpy(file.data() + header.indexOffset, index.data(), index.size());
    return file;
}

Bytes changedFile(const std::uint8_t* data, std::size_t size) {
    static const Bytes kReal = realFile();
    if (data[0] == 255)
        return {data + 1, data + size};
    Bytes file = kReal;
    const std::size_t begin = data[0] % 2 == 0 ? 0 : sizeof(terrain::FileHeader) + kPageBytes;
    const std::size_t end = data[0] % 2 == 0 ? sizeof(terrain::FileHeader) : file.size();
    for (std::size_t k = 1; k + 4 <= size; k += 4) {
        const std::size_t offset =
            data[k] | std::size_t{data[k + 1]} << 8 | std::size_t{data[k + 2]} << 16;
        file[begin + offset % (end - begin)] = data[k + 3];
    }
    return file;
}

/// What must be right before anything else is looked at.
void putRight(Bytes& file) {
    terrain::FileHeader header;
    std::memcpy(static_cast<void*>(&header), file.data(), sizeof header);
    header.magic = terrain::kEytMagic;
    header.version = terrain::kEytVersion;
    if (header.indexOffset <= file.size() && header.indexBytes <= file.size() - header.indexOffset)
        header.indexChecksum = XXH64(file.data() + header.indexOffset, header.indexBytes, 0);
    header.headerChecksum = XXH64(&header, offsetof(terrain::FileHeader, headerChecksum), 0);
    std::memcpy(file.data(), &header, sizeof header);
}

/// Uses what the index promises, as a renderer would.
void use(const terrain::EytFile& file) {
    const terrain::EytIndex& index = file.index();
    for (std::size_t k = 0; k < index.tiles.size(); ++k)
        if (!std::isfinite(index.tiles[k].greatestErrorMetres()))
            std::abort();
    if (index.bounds().isEmpty() || !(index.coarsestErrorMetres() >= 0) ||
        !(index.finestErrorMetres() >= 0))
        std::abort();
    static_cast<void>(index.triangles());
    for (std::uint32_t page = 0; page < index.pages.size(); ++page)
        if (const auto read = file.readPage(page);
            !read.ok() && read.status().code() != absl::StatusCode::kDataLoss)
            std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    Bytes bytes = changedFile(data, size);
    if (bytes.size() >= sizeof(terrain::FileHeader))
        putRight(bytes);
    const int fd = memfd_create("terrain", MFD_CLOEXEC);
    if (fd < 0 || write(fd, bytes.data(), bytes.size()) < 0)
        std::abort();
    const auto file = terrain::EytFile::open("/proc/self/fd/" + std::to_string(fd));
    if (file.ok())
        use(**file);
    else if (file.status().code() != absl::StatusCode::kDataLoss &&
             file.status().code() != absl::StatusCode::kInvalidArgument)
        std::abort();
    close(fd);
    return 0;
}
