// SPDX-License-Identifier: Apache-2.0
// PNG (Portable Network Graphics Specification, Third Edition, W3C 2025), as plain as it can be:
// IHDR, one IDAT, IEND. Rows are filtered by Sub and compressed with zlib's level 1 looking for
// runs only: of zlib's ways the one that makes least of rendered terrain, and among the fastest.
// docs/decisions/0043-still-pictures-bit-for-bit.md has what others take.
#include "wire/png.h"

#include <cstdint>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

#include "fabric/status.h"

namespace eyrie::wire {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kChannels = 3;
constexpr std::byte kSubFilter{1};

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
    const auto* typeAndData = reinterpret_cast<const Bytef*>(&bytes[start + 4]);
    putBigEndian(bytes,
                 static_cast<std::uint32_t>(crc32(0, typeAndData, static_cast<uInt>(length + 4))));
}

/// Rows from the top, each a filter's number and the differences from the pixel before.
Bytes filtered(const fabric::Image& image) {
    const auto width = static_cast<std::size_t>(image.area.width);
    const auto height = static_cast<std::size_t>(image.area.height);
    Bytes rows(height * (1 + kChannels * width));
    std::byte* out = rows.data();
    for (std::size_t y = height; y-- > 0;) {
        *out++ = kSubFilter;
        fabric::Rgba before{0, 0, 0, 0};
        for (std::size_t x = 0; x < width; ++x) {
            const fabric::Rgba pixel = image.colour[y * width + x];
            *out++ = static_cast<std::byte>(pixel.r - before.r);
            *out++ = static_cast<std::byte>(pixel.g - before.g);
            *out++ = static_cast<std::byte>(pixel.b - before.b);
            before = pixel;
        }
    }
    return rows;
}

absl::Status appendCompressed(const Bytes& rows, Bytes& bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, 1, Z_DEFLATED, 15, 9, Z_RLE) != Z_OK)
        return absl::ResourceExhaustedError("png: no memory for a compressor");
    const std::size_t start = bytes.size();
    bytes.resize(start + deflateBound(&stream, static_cast<uLong>(rows.size())));
    // zlib's interface is not const; it only reads.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(rows.data()));
    stream.avail_in = static_cast<uInt>(rows.size());
    stream.next_out = reinterpret_cast<Bytef*>(&bytes[start]);
    stream.avail_out = static_cast<uInt>(bytes.size() - start);
    const int result = deflate(&stream, Z_FINISH);
    bytes.resize(start + stream.total_out);
    deflateEnd(&stream);
    return result == Z_STREAM_END ? absl::OkStatus()
                                  : absl::InternalError(fmt::format("png: zlib says {}", result));
}

absl::Status checkEncodable(const fabric::Image& image) {
    constexpr std::int64_t kMaxPixels = std::int64_t{1} << 30;  // zlib counts bytes in 32 bits
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
