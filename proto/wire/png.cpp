// SPDX-License-Identifier: Apache-2.0
// PNG (Portable Network Graphics Specification, Third Edition, W3C 2025), as plain as it can be:
// IHDR, one IDAT, IEND. Rows are filtered by Sub and compressed with libdeflate's level 2:
// docs/decisions/0043-still-pictures-bit-for-bit.md has what others take.
#include "wire/png.h"

#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <libdeflate.h>

#include "fabric/status.h"

namespace eyrie::wire {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kChannels = 3;
constexpr std::byte kSubFilter{1};
constexpr int kLevel = 2;
constexpr std::size_t kMostAfterIt = 16;  ///< the checksum and IEND

struct FreeCompressor {
    void operator()(libdeflate_compressor* compressor) const {
        libdeflate_free_compressor(compressor);
    }
};

void putBigEndian(Bytes& bytes, std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::byte>(value >> shift));
}

/// Starts a chunk and returns where; its length follows with endChunk.
std::size_t beginChunk(Bytes& bytes, std::string_view type) {
    const std::size_t start = bytes.size();
    putBigEndian(bytes, 0);
    for (const char letter : type) bytes.push_back(static_cast<std::byte>(letter));
    return start;
}

void endChunk(Bytes& bytes, std::size_t start) {
    const std::size_t length = bytes.size() - start - 8;
    for (std::size_t i = 0; i < 4; ++i)
        bytes[start + i] = static_cast<std::byte>(length >> (24 - 8 * i));
    putBigEndian(bytes, libdeflate_crc32(0, &bytes[start + 4], length + 4));
}

/// What is to be added to each of four bytes of `before` for `pixel`, without carries between them.
std::uint32_t difference(std::uint32_t pixel, std::uint32_t before) {
    constexpr std::uint32_t kHigh = 0x80808080u;
    return ((pixel | kHigh) - (before & ~kHigh)) ^ ((pixel ^ ~before) & kHigh);
}

/// Memory that nothing is written into before it is used.
struct Room {
    explicit Room(std::size_t bytes)
        : data(std::make_unique_for_overwrite<std::byte[]>(bytes)), size(bytes) {}

    std::unique_ptr<std::byte[]> data;
    std::size_t size;
};

/// Rows from the top, each a filter's number and the differences from the pixel before.
Room filtered(const fabric::Image& image) {
    const auto width = static_cast<std::size_t>(image.area.width);
    const auto height = static_cast<std::size_t>(image.area.height);
    // A pixel is written with its alpha, which the next one writes over.
    Room rows(height * (1 + kChannels * width) + 1);
    std::byte* out = rows.data.get();
    for (std::size_t y = height; y-- > 0;) {
        *out++ = kSubFilter;
        std::uint32_t before = 0;
        for (std::size_t x = 0; x < width; ++x) {
            std::uint32_t pixel;
            static_assert(sizeof pixel == sizeof(fabric::Rgba));
            std::memcpy(&pixel, &image.colour[y * width + x], sizeof pixel);
            const std::uint32_t step = difference(pixel, before);
            std::memcpy(out, &step, sizeof step);
            out += kChannels;
            before = pixel;
        }
    }
    --rows.size;
    return rows;
}

absl::Status appendCompressed(const Room& rows, Bytes& bytes) {
    const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(
        libdeflate_alloc_compressor(kLevel));
    if (compressor == nullptr)
        return absl::ResourceExhaustedError("png: no memory for a compressor");
    const Room packed(libdeflate_zlib_compress_bound(compressor.get(), rows.size));
    const std::size_t size = libdeflate_zlib_compress(compressor.get(), rows.data.get(), rows.size,
                                                      packed.data.get(), packed.size);
    if (size == 0)
        return absl::InternalError("png: libdeflate found no room");
    bytes.reserve(bytes.size() + size + kMostAfterIt);
    bytes.insert(bytes.end(), packed.data.get(), packed.data.get() + size);
    return absl::OkStatus();
}

absl::Status checkEncodable(const fabric::Image& image) {
    constexpr std::int64_t kMaxPixels = std::int64_t{1} << 29;  // a chunk has 2^31 bytes at most
    const fabric::PixelViewport& area = image.area;
    if (area.isEmpty() || area.area() > kMaxPixels)
        return absl::InvalidArgumentError(
            fmt::format("png: the image is {}x{} pixels; expected 1 to {} in all", area.width,
                        area.height, kMaxPixels));
    if (static_cast<std::int64_t>(image.colour.size()) != area.area())
        return absl::InvalidArgumentError(
            fmt::format("png: the image has {} pixels of colour for an area of {}x{}",
                        image.colour.size(), area.width, area.height));
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::vector<std::byte>> encodePng(const fabric::Image& image) {
    RETURN_IF_ERROR(checkEncodable(image));
    Bytes bytes;
    constexpr unsigned char kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const unsigned char one : kSignature) bytes.push_back(std::byte{one});
    std::size_t chunk = beginChunk(bytes, "IHDR");
    putBigEndian(bytes, static_cast<std::uint32_t>(image.area.width));
    putBigEndian(bytes, static_cast<std::uint32_t>(image.area.height));
    constexpr unsigned char kForm[] = {8, 2, 0, 0, 0};  // bits, RGB, deflate, filters, plain rows
    for (const unsigned char one : kForm) bytes.push_back(std::byte{one});
    endChunk(bytes, chunk);
    chunk = beginChunk(bytes, "IDAT");
    RETURN_IF_ERROR(appendCompressed(filtered(image), bytes));
    endChunk(bytes, chunk);
    endChunk(bytes, beginChunk(bytes, "IEND"));
    return bytes;
}

}  // namespace eyrie::wire
