// SPDX-License-Identifier: Apache-2.0
// Size and decoding speed of a terrain's pages, beside what else could hold the same tiles.
//
//   build/release/bench/page_codec FILE.eyt [ROUNDS=9]
//
// Prints a table; speeds are those of the median round, in processor time of one thread. Triangles
// are those of interiors and own borders; the bits hold the borders for finer neighbours as well.
// Samples are those of the normals: the finest levels share theirs.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <functional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <zstd.h>

#include "renderer/terrain/codec/geometry_decoder.h"
#include "renderer/terrain/codec/normal_codec.h"
#include "renderer/terrain/eyt_format.h"

namespace {

using namespace eyrie::terrain;

using Bytes = std::vector<unsigned char>;
constexpr int kZstdLevel = 12;

/// A page as it lies on disk, and decoded.
struct LoadedPage {
    std::vector<std::uint32_t> bytes;
    PageHeader header;
    Page page;
};

std::vector<LoadedPage> load(const EytFile& file) {
    std::ifstream stream(file.path(), std::ios::binary);
    std::vector<LoadedPage> pages;
    for (const PageRecord& record : file.index().pages) {
        if (record.bytes == 0)
            continue;
        std::vector<std::uint32_t> bytes(record.bytes / sizeof(std::uint32_t));
        stream.seekg(static_cast<std::streamoff>(record.offset));
        stream.read(reinterpret_cast<char*>(bytes.data()),
                    static_cast<std::streamsize>(record.bytes));
        auto page = Page::decode(bytes, file.path());
        if (!page.ok()) {
            fmt::print(stderr, "{}\n", page.status().ToString());
            std::exit(1);
        }
        PageHeader header;
        std::memcpy(static_cast<void*>(&header), bytes.data(), sizeof header);
        pages.push_back({std::move(bytes), header, *std::move(page)});
    }
    return pages;
}

/// Tiles without triangles may have normals.
template <typename Visit>
void forEachTile(const std::vector<LoadedPage>& pages, Visit visit) {
    for (const LoadedPage& page : pages)
        for (int place = 0; place < kPageTiles * kPageTiles; ++place) visit(page.page.tile(place));
}

double seconds(const std::function<void()>& work, int rounds) {
    std::vector<double> times;
    for (int k = 0; k < rounds; ++k) {
        const std::clock_t start = std::clock();
        work();
        times.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    std::nth_element(times.begin(), times.begin() + rounds / 2, times.end());
    return times[static_cast<std::size_t>(rounds / 2)];
}

const std::uint8_t* bitsOf(const LoadedPage& page) {
    return reinterpret_cast<const std::uint8_t*>(page.bytes.data()) + sizeof page.header;
}

/// Decodes the geometry of a page, without normals.
void decodeGeometry(const LoadedPage& page, std::vector<std::uint32_t>& words,
                    std::vector<std::uint16_t>& indices) {
    const PageHeader& header = page.header;
    const std::uint8_t* bits = bitsOf(page);
    GeometryDecoder decoder(
        {reinterpret_cast<const std::uint16_t*>(bits), header.wordBytes / sizeof(std::uint16_t)},
        {bits + header.wordBytes, header.rawBytes});
    const char* wrong = decoder.begin();
    for (const TileHeader& tile : header.tiles) {
        if (tile.vertices == 0 || wrong != nullptr)
            continue;
        words.resize(std::size_t{tile.vertices} * tile.wordsPerVertex);
        indices.resize(3 * std::size_t{tile.triangles});
        std::array<IndexRange, kTileParts> parts;
        wrong = decoder.decode(
            tile, {header.cells, header.finerStep, tile.limitX, tile.limitY, tile.finerEdges},
            words, indices, parts);
    }
    if (wrong != nullptr)
        std::abort();
}

void decodeNormals(const LoadedPage& page, std::vector<std::int8_t>& normals) {
    const PageHeader& header = page.header;
    NormalDecoder decoder({bitsOf(page) + header.wordBytes + header.rawBytes, header.normalBytes},
                          header.cells);
    normals.resize(2 * (std::size_t{header.cells} + 1) * (std::size_t{header.cells} + 1));
    bool isGood = header.normalTiles == 0 || decoder.begin();
    for (std::size_t place = 0; place < header.tiles.size(); ++place)
        isGood = isGood && ((header.normalTiles >> place & 1) == 0 || decoder.decode(normals));
    if (!isGood)
        std::abort();
}

/// One tile by meshoptimizer: vertices of 8 bytes (x, y, height in two halves) and indices, both
/// in the order its codecs like best.
struct MeshoptTile {
    std::size_t vertices = 0;
    std::size_t indices = 0;
    Bytes vertexBytes;
    Bytes indexBytes;
};

using MeshoptVertex = std::array<std::uint16_t, 4>;

MeshoptTile encodeMeshopt(const TileGeometry& tile) {
    const auto stride = static_cast<std::size_t>(tile.wordsPerVertex);
    std::vector<MeshoptVertex> vertices(tile.vertexCount());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const std::uint32_t word = tile.words[k * stride];
        const std::uint32_t height = stride == 2 ? tile.words[2 * k + 1] : word >> 20;
        vertices[k] = {
            static_cast<std::uint16_t>(word & 1023), static_cast<std::uint16_t>(word >> 10 & 1023),
            static_cast<std::uint16_t>(height), static_cast<std::uint16_t>(height >> 16)};
    }
    std::vector<std::uint32_t> indices(tile.indices.begin(), tile.indices.end());
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices.size());
    meshopt_optimizeVertexFetch(vertices.data(), indices.data(), indices.size(), vertices.data(),
                                vertices.size(), sizeof(MeshoptVertex));
    MeshoptTile out{vertices.size(), indices.size(), {}, {}};
    out.vertexBytes.resize(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(MeshoptVertex)));
    out.vertexBytes.resize(meshopt_encodeVertexBuffer(out.vertexBytes.data(),
                                                      out.vertexBytes.size(), vertices.data(),
                                                      vertices.size(), sizeof(MeshoptVertex)));
    out.indexBytes.resize(meshopt_encodeIndexBufferBound(indices.size(), vertices.size()));
    out.indexBytes.resize(meshopt_encodeIndexBuffer(out.indexBytes.data(), out.indexBytes.size(),
                                                    indices.data(), indices.size()));
    return out;
}

void decodeMeshopt(const MeshoptTile& tile, const unsigned char* vertexBytes,
                   const unsigned char* indexBytes) {
    thread_local std::vector<MeshoptVertex> vertices;
    thread_local std::vector<std::uint16_t> indices;
    vertices.resize(tile.vertices);
    indices.resize(tile.indices);
    if (meshopt_decodeVertexBuffer(vertices.data(), tile.vertices, sizeof(MeshoptVertex),
                                   vertexBytes, tile.vertexBytes.size()) != 0 ||
        meshopt_decodeIndexBuffer(indices.data(), tile.indices, sizeof(std::uint16_t), indexBytes,
                                  tile.indexBytes.size()) != 0)
        std::abort();
}

Bytes zstd(const Bytes& bytes) {
    Bytes out(ZSTD_compressBound(bytes.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel));
    return out;
}

/// A page of tiles by meshoptimizer, and all of it once more by zstd.
struct MeshoptPage {
    std::vector<MeshoptTile> tiles;
    std::size_t bytes = 0;
    Bytes compressed;
};

MeshoptPage encodeMeshopt(const LoadedPage& page) {
    MeshoptPage out;
    Bytes all;
    for (int place = 0; place < kPageTiles * kPageTiles; ++place) {
        if (page.page.tile(place).isEmpty())
            continue;
        const MeshoptTile& tile = out.tiles.emplace_back(encodeMeshopt(page.page.tile(place)));
        all.insert(all.end(), tile.vertexBytes.begin(), tile.vertexBytes.end());
        all.insert(all.end(), tile.indexBytes.begin(), tile.indexBytes.end());
    }
    out.bytes = all.size();
    out.compressed = zstd(all);
    return out;
}

void decodeCompressed(const MeshoptPage& page) {
    thread_local Bytes all;
    all.resize(page.bytes);
    ZSTD_decompress(all.data(), all.size(), page.compressed.data(), page.compressed.size());
    const unsigned char* next = all.data();
    for (const MeshoptTile& tile : page.tiles) {
        decodeMeshopt(tile, next, next + tile.vertexBytes.size());
        next += tile.vertexBytes.size() + tile.indexBytes.size();
    }
}

/// What is left of a page's normals after left + up - upleft, plane by plane, under zstd.
struct ZstdNormals {
    std::size_t bytes = 0;
    Bytes compressed;
};

ZstdNormals encodeZstdNormals(const LoadedPage& page) {
    const auto side = static_cast<std::size_t>(page.header.cells) + 1;
    Bytes left;
    for (int place = 0; place < kPageTiles * kPageTiles; ++place) {
        const std::span<const std::int8_t> normals = page.page.tile(place).normals;
        for (std::size_t plane = 0; plane < 2 && !normals.empty(); ++plane)
            for (std::size_t k = 0; k < side * side; ++k) {
                const auto at = [&](std::size_t sample) { return normals[2 * sample + plane]; };
                const bool hasLeft = k % side > 0;
                const int up = k >= side ? at(k - side) : 0;
                const int upLeft = hasLeft && k >= side ? at(k - side - 1) : 0;
                left.push_back(
                    static_cast<unsigned char>(at(k) - (hasLeft ? at(k - 1) : 0) - up + upLeft));
            }
    }
    return {left.size(), zstd(left)};
}

struct Totals {
    double triangles = 0;
    double samples = 0;
    double rawBytes = 0;
    double geometryBytes = 0;
    double normalBytes = 0;
    double headerBytes = 0;
};

Totals totalsOf(const std::vector<LoadedPage>& pages) {
    Totals totals;
    forEachTile(pages, [&](const TileGeometry& tile) {
        totals.triangles += tile.parts[kFinerPart].first / 3;
        totals.samples += static_cast<double>(tile.normals.size()) / 2;
        totals.rawBytes += static_cast<double>(tile.words.size_bytes() + tile.indices.size_bytes());
    });
    for (const LoadedPage& page : pages) {
        totals.geometryBytes += page.header.wordBytes + page.header.rawBytes;
        totals.normalBytes += page.header.normalBytes;
        totals.headerBytes += sizeof page.header;
    }
    return totals;
}

void printRow(const char* name, double bytes, double time, const Totals& totals) {
    fmt::print("| {:<24} | {:>8.2f} | {:>8.2f} | {:>8.1f} |\n", name, 8 * bytes / totals.triangles,
               8 * bytes / totals.samples, totals.triangles / time / 1e6);
}

void compare(const std::vector<LoadedPage>& pages, const Totals& totals, int rounds) {
    std::vector<MeshoptPage> meshopt;
    double meshoptBytes = 0;
    double compressedBytes = 0;
    for (const LoadedPage& page : pages) {
        meshopt.push_back(encodeMeshopt(page));
        meshoptBytes += static_cast<double>(meshopt.back().bytes);
        compressedBytes += static_cast<double>(meshopt.back().compressed.size());
    }
    std::vector<std::uint32_t> words;
    std::vector<std::uint16_t> indices;
    fmt::print("| geometry                 | bits/tri | b/sample |  M tri/s |\n");
    const double copying = seconds(
        [&] {
            forEachTile(pages, [&](const TileGeometry& tile) {
                words.assign(tile.words.begin(), tile.words.end());
                indices.assign(tile.indices.begin(), tile.indices.end());
            });
        },
        rounds);
    printRow("raw (copied)", totals.rawBytes, copying, totals);
    const double plain = seconds(
        [&] {
            for (const MeshoptPage& page : meshopt)
                for (const MeshoptTile& tile : page.tiles)
                    decodeMeshopt(tile, tile.vertexBytes.data(), tile.indexBytes.data());
        },
        rounds);
    printRow("meshoptimizer", meshoptBytes, plain, totals);
    const double compressed =
        seconds([&] { std::for_each(meshopt.begin(), meshopt.end(), decodeCompressed); }, rounds);
    printRow("meshoptimizer + zstd", compressedBytes, compressed, totals);
    const double ours = seconds(
        [&] {
            for (const LoadedPage& page : pages) decodeGeometry(page, words, indices);
        },
        rounds);
    printRow("ours", totals.geometryBytes + totals.headerBytes, ours, totals);
    const double all = seconds(
        [&] {
            for (const LoadedPage& page : pages)
                if (!Page::decode(page.bytes, "").ok())
                    std::abort();
        },
        rounds);
    printRow("ours, normals too", totals.geometryBytes + totals.headerBytes + totals.normalBytes,
             all, totals);
}

void compareNormals(const std::vector<LoadedPage>& pages, const Totals& totals, int rounds) {
    std::vector<std::int8_t> normals;
    std::vector<ZstdNormals> zstdPages;
    double zstdBytes = 0;
    for (const LoadedPage& page : pages) {
        zstdPages.push_back(encodeZstdNormals(page));
        zstdBytes += static_cast<double>(zstdPages.back().compressed.size());
    }
    const auto print = [&](const char* name, double bytes, double time) {
        fmt::print("| {:<36} | {:>8.2f} | {:>10.1f} |\n", name, 8 * bytes / totals.samples,
                   totals.samples / time / 1e6);
    };
    fmt::print("| normals                              | b/sample | M sample/s |\n");
    Bytes left;
    const double unpacking = seconds(
        [&] {
            for (const ZstdNormals& page : zstdPages) {
                left.resize(page.bytes);
                ZSTD_decompress(left.data(), left.size(), page.compressed.data(),
                                page.compressed.size());
            }
        },
        rounds);
    print("left + up - upleft, zstd; unpacked", zstdBytes, unpacking);
    const double ours = seconds(
        [&] {
            for (const LoadedPage& page : pages) decodeNormals(page, normals);
        },
        rounds);
    print("ours", totals.normalBytes, ours);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || std::string_view(argv[1]) == "--help") {
        fmt::print(stderr, "usage: page_codec FILE.eyt [ROUNDS=9]\n");
        return 2;
    }
    const auto file = EytFile::open(argv[1]);
    if (!file.ok()) {
        fmt::print(stderr, "{}\n", file.status().ToString());
        return 1;
    }
    const std::vector<LoadedPage> pages = load(**file);
    const Totals totals = totalsOf(pages);
    fmt::print("{}: {} bytes in {} pages: geometry {}, normals {}, page headers {}; index {}\n",
               argv[1], (*file)->sizeBytes(), pages.size(), totals.geometryBytes,
               totals.normalBytes, totals.headerBytes,
               static_cast<double>((*file)->sizeBytes()) - totals.geometryBytes -
                   totals.normalBytes - totals.headerBytes);
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
    if (totals.triangles > 0) {
        compare(pages, totals, rounds);
        compareNormals(pages, totals, rounds);
    }
    return 0;
}
