// SPDX-License-Identifier: Apache-2.0
// What GDAL 3.6 takes with libjpeg-turbo 2.1, libwebp 1.2 and OpenJPEG 2.5: measured.
#include "renderer/import/whole_decoding.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <cpl_string.h>
#include <cpl_vsi.h>

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {
namespace {

using File = std::unique_ptr<VSILFILE, Releaser<VSIFCloseL>>;

std::uint64_t sizeOf(const std::string& name) {
    VSIStatBufL status;
    return VSIStatL(name.c_str(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

/// Of the head of a JPEG's frame: values of all components, some of which may have fewer.
double valuesAPixel(std::span<const std::uint8_t> frame) {
    int across = 1, down = 1, values = 0;  // of the smallest piece that has whole ones of each
    for (std::size_t at = 7; at < frame.size(); at += 3) {
        const int x = frame[at] >> 4, y = frame[at] & 15;
        across = std::max(across, x);
        down = std::max(down, y);
        values += x * y;
    }
    return static_cast<double>(values) / (across * down);
}

/// Of a JPEG in several scans libjpeg keeps all coefficients, two bytes each.
std::uint64_t coefficientBytes(const std::string& name, std::uint64_t pixels) {
    constexpr std::uint8_t kHuffmanTables = 0xc4, kExtension = 0xc8, kArithmeticTables = 0xcc;
    constexpr std::uint8_t kScan = 0xda;
    const File file(VSIFOpenL(name.c_str(), "rb"));
    if (!file || VSIFSeekL(file.get(), 2, SEEK_SET) != 0)
        return 0;
    double values = 0;
    int components = 0;
    bool isProgressive = false;
    std::array<std::uint8_t, 4> head{};  // of a segment: marker and length, of itself, too
    while (VSIFReadL(head.data(), 1, head.size(), file.get()) == head.size()) {
        const std::uint8_t marker = head[1];
        const std::size_t length = static_cast<std::size_t>(head[2]) << 8 | head[3];
        if (head[0] != 0xff || length <= 2)
            return 0;
        std::vector<std::uint8_t> body(length - 2);
        if (VSIFReadL(body.data(), 1, body.size(), file.get()) != body.size())
            return 0;
        if (marker == kScan)
            return isProgressive || body[0] < components
                       ? static_cast<std::uint64_t>(2 * values * static_cast<double>(pixels))
                       : 0;
        const bool isFrame = marker >= 0xc0 && marker < 0xd0 && marker != kHuffmanTables &&
                             marker != kExtension && marker != kArithmeticTables;
        if (!isFrame || body.size() < 6)
            continue;
        isProgressive = (marker & 3) == 2;
        components = body[5];
        values = valuesAPixel(body);
    }
    return 0;
}

/// Whether a code stream of JPEG 2000, in boxes or not, has one tile.
bool hasOneTile(const std::string& name) {
    constexpr std::array<std::uint8_t, 4> kBegin = {0xff, 0x4f, 0xff, 0x51};
    constexpr std::size_t kSearched = std::size_t{1} << 20;
    const File file(VSIFOpenL(name.c_str(), "rb"));
    std::vector<std::uint8_t> bytes(kSearched);
    if (file)
        bytes.resize(VSIFReadL(bytes.data(), 1, bytes.size(), file.get()));
    const auto begin = std::search(bytes.begin(), bytes.end(), kBegin.begin(), kBegin.end());
    constexpr std::ptrdiff_t kFirstNumber = 8, kNumbers = 8;
    if (!file || bytes.end() - begin < kFirstNumber + 4 * kNumbers)
        return false;
    const auto number = [&](std::ptrdiff_t k) {
        const auto at = begin + kFirstNumber + 4 * k;
        return std::uint64_t{at[0]} << 24 | std::uint64_t{at[1]} << 16 | std::uint64_t{at[2]} << 8 |
               at[3];
    };
    // The far corner, the first pixel; tiles' sides, the first tile.
    return number(4) + number(6) >= number(0) && number(5) + number(7) >= number(1);
}

/// OpenJPEG keeps the coded tile and what it knows of its blocks, and decodes windows of it.
std::uint64_t tileBytes(const std::string& name, std::uint64_t pixels, std::uint64_t bands) {
    constexpr std::uint64_t kWindowPixels = std::uint64_t{1} << 20;
    constexpr std::uint64_t kWindowBytes = 10;  // of a band's pixel
    if (!hasOneTile(name))
        return 0;
    return sizeOf(name) + bands * (pixels / 2 + kWindowBytes * std::min(pixels, kWindowPixels));
}

}  // namespace

std::uint64_t wholeDecodingBytes(GDALDatasetH raster) {
    const GDALDriverH driver = GDALGetDatasetDriver(raster);
    if (driver == nullptr)
        return 0;
    const std::string format = GDALGetDriverShortName(driver);
    const std::string name = GDALGetDescription(raster);
    const std::uint64_t pixels = static_cast<std::uint64_t>(GDALGetRasterXSize(raster)) *
                                 static_cast<std::uint64_t>(GDALGetRasterYSize(raster));
    const auto bands = static_cast<std::uint64_t>(GDALGetRasterCount(raster));
    if (format == "JPEG")
        return coefficientBytes(name, pixels);
    if (format == "WEBP") {
        const char* const loss =
            GDALGetMetadataItem(raster, "COMPRESSION_REVERSIBILITY", "IMAGE_STRUCTURE");
        const bool isLossless = loss != nullptr && EQUAL(loss, "LOSSLESS");
        return pixels * (bands + (isLossless ? 4 : 0)) + sizeOf(name);
    }
    if (format == "GIF")
        return pixels * bands;
    return format == "JP2OpenJPEG" ? tileBytes(name, pixels, bands) : 0;
}

}  // namespace eyrie::import
