// SPDX-License-Identifier: Apache-2.0
// .eyt files, whose header, index and pages are untrusted once their checksums are right.
//
// An input's first byte picks how it is read. 255 takes the rest for a file. Otherwise each four
// bytes after it put the fourth at the offset that the first three name, in a real terrain's header
// (0, 3, ...), index (1, ...) or pages (2, ...): so inputs reach past the checks of sizes.
// Checksums are put right, those of pages in the real terrain only.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>
#include <xxhash.h>

#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_layout.h"
#include "tests/renderer/import/imagery_fixture.h"

namespace {

using namespace eyrie;
using Bytes = std::vector<std::uint8_t>;

/// A terrain with imagery.
Bytes realFile() {
    const test::TemporaryFolder folder;
    const test::Picture picture{.west = test::kWest,
                                .north = test::kSouth + 60,
                                .columns = 140,
                                .rows = 60,
                                .colour = [](double x, double y) {
                                    return fabric::Rgba{static_cast<std::uint8_t>(x),
                                                        static_cast<std::uint8_t>(y), 99, 255};
                                }};
    test::writePicture(folder.path("picture.tif"), picture);
    const auto file =
        test::importedWith(test::slope(140, 70, 1), {folder.path("picture.tif")}, folder);
    const std::string bytes = test::contents((*file)->path());
    return {bytes.begin(), bytes.end()};
}

const Bytes& real() {
    static const Bytes kReal = realFile();
    return kReal;
}

terrain::FileHeader headerOf(const Bytes& file) {
    terrain::FileHeader header;
    std::memcpy(static_cast<void*>(&header), file.data(), sizeof header);
    return header;
}

/// Of the bytes that an input of that kind changes.
std::pair<std::size_t, std::size_t> changeable(std::uint8_t kind) {
    const terrain::FileHeader header = headerOf(real());
    if (kind % 3 == 0)
        return {0, sizeof header};
    return kind % 3 == 1 ? std::pair(header.indexOffset, real().size())
                         : std::pair(sizeof header, header.indexOffset);
}

Bytes changedFile(const std::uint8_t* data, std::size_t size) {
    if (data[0] == 255)
        return {data + 1, data + size};
    Bytes file = real();
    const auto [begin, end] = changeable(data[0]);
    for (std::size_t k = 1; k + 4 <= size; k += 4) {
        const std::size_t offset =
            data[k] | std::size_t{data[k + 1]} << 8 | std::size_t{data[k + 2]} << 16;
        file[begin + offset % (end - begin)] = data[k + 3];
    }
    return file;
}

/// Puts the checksums in an array of records right, wherever these name bytes of the file.
void sealPages(Bytes& file, std::size_t begin, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
        std::uint8_t* const at = file.data() + begin + k * sizeof(terrain::PageRecord);
        terrain::PageRecord page;
        std::memcpy(&page, at, sizeof page);
        if (page.offset <= file.size() && page.bytes <= file.size() - page.offset)
            page.checksum = XXH64(file.data() + page.offset, page.bytes, 0);
        std::memcpy(at, &page, sizeof page);
    }
}

/// Those of a file whose index is as long as the real one's.
void sealPages(Bytes& file) {
    const terrain::FileHeader header = headerOf(real());
    const terrain::Quadtree quadtree(header.columns, header.rows);
    const std::size_t tiles = header.indexOffset + terrain::roundUp(header.crsBytes, 8);
    const std::size_t pages =
        header.indexOffset +
        terrain::roundUp(
            tiles - header.indexOffset + quadtree.tileCount() * sizeof(terrain::TileRecord), 8);
    sealPages(file, pages, quadtree.pageCount());
    constexpr std::size_t kImageryHeader = 32;
    const std::size_t textures =
        pages + quadtree.pageCount() * sizeof(terrain::PageRecord) + kImageryHeader;
    sealPages(file, textures, (file.size() - textures) / sizeof(terrain::PageRecord));
}

/// What must be right before anything else is looked at.
void putRight(Bytes& file) {
    terrain::FileHeader header = headerOf(file);
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
    const auto expect = [](const absl::Status& status) {
        if (!status.ok() && status.code() != absl::StatusCode::kDataLoss)
            std::abort();
    };
    for (std::uint32_t page = 0; page < index.pages.size(); ++page)
        expect(file.readPage(page).status());
    for (std::uint32_t k = 0; index.imagery && k < index.imagery->pyramid.tileCount(); ++k)
        expect(file.readTexture(index.imagery->pyramid.tileOf(k)).status());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    Bytes bytes = changedFile(data, size);
    if (data[0] != 255)
        sealPages(bytes);
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
