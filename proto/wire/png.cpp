// SPDX-License-Identifier: Apache-2.0
// PNG (Portable Network Graphics Specification, Third Edition, W3C 2025), as plain as it can be:
// IHDR, one IDAT, IEND. Every row has the filter Paeth and is compressed by PixelDeflate:
// docs/decisions/0080-pngs-by-pixels.md has what others take.
#include "wire/png.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <libdeflate.h>

#include "fabric/simd_clones.h"
#include "fabric/status.h"
#include "wire/pixel_deflate.h"

namespace eyrie::wire {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kChannels = PixelDeflate::kPixel;
constexpr std::uint8_t kPaeth = 4;
/// Of a block of rows: it stays in a core's own cache, and codes of its own cost it little.
constexpr std::size_t kBlockBytes = std::size_t{1} << 18;

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

EYRIE_SIMD_CLONES
void dropAlpha(std::span<const fabric::Rgba> pixels, std::uint8_t* __restrict channels) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        channels[kChannels * i] = pixels[i].r;
        channels[kChannels * i + 1] = pixels[i].g;
        channels[kChannels * i + 2] = pixels[i].b;
    }
}

/// Writes what is to be added to Paeth's guess of each byte from the second pixel on: the one of
/// left, above and the corner between that is nearest to left + above - corner. In bytes alone, of
/// which a vector has the most: where both neighbours are on the same side of the corner, they are
/// nearer than the corner; else that is as far as their distances from it are apart.
EYRIE_SIMD_CLONES
void subtractGuesses(std::span<const std::uint8_t> row, const std::uint8_t* __restrict above,
                     std::uint8_t* __restrict differences) {
    using Byte = std::uint8_t;
    const auto distance = [](Byte one, Byte other) {
        return static_cast<Byte>(std::max(one, other) - std::min(one, other));
    };
    for (std::size_t i = kChannels; i < row.size(); ++i) {
        const Byte left = row[i - kChannels], up = above[i], corner = above[i - kChannels];
        const Byte fromLeft = distance(up, corner), fromUp = distance(left, corner);
        const Byte lower = std::min(left, up), upper = std::max(left, up);
        const Byte apart = distance(fromLeft, fromUp);
        const Byte fromCorner =
            std::min(std::max(lower, corner), upper) == corner ? apart : Byte{255};
        const Byte nearer = fromUp <= fromCorner ? up : corner;
        const Byte guess = fromLeft <= std::min(fromUp, fromCorner) ? left : nearer;
        differences[i] = static_cast<Byte>(row[i] - guess);
    }
}

/// Rows from the top, each the filter's number and the differences from what it guesses.
class FilteredRows {
public:
    explicit FilteredRows(const fabric::Image& image)
        : image_(image),
          rowBytes_(1 + kChannels * width()),
          rowsInBlock_(std::clamp<std::size_t>(kBlockBytes / rowBytes_, 1, height())),
          block_(rowsInBlock_ * rowBytes_ + PixelDeflate::kReadBeyond),
          row_(kChannels * width()),
          above_(kChannels * width()) {}

    std::size_t rowBytes() const { return rowBytes_; }
    bool isAtEnd() const { return done_ == height(); }

    /// Further rows, until next time, with PixelDeflate::kReadBeyond bytes of memory after them.
    std::span<const std::byte> next() {
        const std::size_t rows = std::min(rowsInBlock_, height() - done_);
        for (std::size_t i = 0; i < rows; ++i, ++done_) filterNext(&block_[i * rowBytes_]);
        return std::as_bytes(std::span(block_.data(), rows * rowBytes_));
    }

private:
    std::size_t width() const { return static_cast<std::size_t>(image_.area.width); }
    std::size_t height() const { return static_cast<std::size_t>(image_.area.height); }

    void filterNext(std::uint8_t* filtered) {
        row_.swap(above_);
        dropAlpha({&image_.colour[(height() - 1 - done_) * width()], width()}, row_.data());
        *filtered++ = kPaeth;
        for (std::size_t i = 0; i < kChannels; ++i)  // left of it is nothing: what is above counts
            filtered[i] = static_cast<std::uint8_t>(row_[i] - above_[i]);
        subtractGuesses(row_, above_.data(), filtered);
    }

    const fabric::Image& image_;
    const std::size_t rowBytes_, rowsInBlock_;
    std::vector<std::uint8_t> block_;
    std::vector<std::uint8_t> row_, above_;  ///< zeros before the first one
    std::size_t done_ = 0;
};

/// A zlib stream (RFC 1950) of all rows.
void appendCompressed(const fabric::Image& image, Bytes& bytes) {
    constexpr std::byte kHead[] = {std::byte{0x78}, std::byte{1}};  // 32 kB far; the fastest
    bytes.insert(bytes.end(), std::begin(kHead), std::end(kHead));
    FilteredRows rows(image);
    const auto deflate = std::make_unique<PixelDeflate>();
    std::uint32_t checksum = 1;
    while (!rows.isAtEnd()) {
        const std::span<const std::byte> block = rows.next();
        checksum = libdeflate_adler32(checksum, block.data(), block.size());
        deflate->append(block, rows.rowBytes(), rows.isAtEnd(), bytes);
    }
    putBigEndian(bytes, checksum);
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
    bytes.reserve(image.colour.size() / 2);  // more than most take: moving it costs more than room
    constexpr unsigned char kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const unsigned char one : kSignature) bytes.push_back(std::byte{one});
    std::size_t chunk = beginChunk(bytes, "IHDR");
    putBigEndian(bytes, static_cast<std::uint32_t>(image.area.width));
    putBigEndian(bytes, static_cast<std::uint32_t>(image.area.height));
    constexpr unsigned char kForm[] = {8, 2, 0, 0, 0};  // bits, RGB, deflate, filters, plain rows
    for (const unsigned char one : kForm) bytes.push_back(std::byte{one});
    endChunk(bytes, chunk);
    chunk = beginChunk(bytes, "IDAT");
    appendCompressed(image, bytes);
    endChunk(bytes, chunk);
    endChunk(bytes, beginChunk(bytes, "IEND"));
    return bytes;
}

}  // namespace eyrie::wire
