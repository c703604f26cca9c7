// SPDX-License-Identifier: Apache-2.0
// PNG (Portable Network Graphics Specification, Third Edition, W3C 2025), as plain as it can be:
// IHDR, an IDAT a block of rows, IEND. Every row has the filter Paeth and is compressed by
// PixelDeflate: docs/decisions/0080-pngs-by-pixels.md has what others take.
#include "wire/png.h"

#include <algorithm>
#include <cstdint>
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

/// Has the processor begin to load a row while it works on the one before: it foresees what is read
/// upwards, but rows come downwards, and a picture is larger than a core's own cache.
void fetch(std::span<const fabric::Rgba> row) {
    constexpr std::size_t kLinePixels = 64 / sizeof(fabric::Rgba);
    for (std::size_t x = 0; x < row.size(); x += kLinePixels) __builtin_prefetch(&row[x]);
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
/// which a vector has the most, and in minima and maxima, which cost least there. Corner itself is
/// `apart` from that sum where it lies between its neighbours, as far as its distances from them
/// differ; else it is farther than both.
EYRIE_SIMD_CLONES
void subtractGuesses(std::span<const std::uint8_t> row, const std::uint8_t* __restrict above,
                     std::uint8_t* __restrict differences) {
    using Byte = std::uint8_t;
    const auto lower = [](Byte one, Byte other) { return one < other ? one : other; };
    const auto upper = [](Byte one, Byte other) { return one < other ? other : one; };
    for (std::size_t i = kChannels; i < row.size(); ++i) {
        const Byte left = row[i - kChannels], up = above[i], corner = above[i - kChannels];
        const Byte fromLeft = static_cast<Byte>(upper(up, corner) - lower(up, corner));
        const Byte fromUp = static_cast<Byte>(upper(left, corner) - lower(left, corner));
        const Byte nearest = lower(fromLeft, fromUp);
        const Byte apart = static_cast<Byte>(upper(fromLeft, fromUp) - nearest);
        const Byte neighbour = fromLeft == nearest ? left : up;
        const Byte between = upper(lower(left, up), lower(upper(left, up), corner));
        const Byte unlessNearer = between == corner ? corner : neighbour;
        const Byte guess = lower(nearest, apart) == nearest ? neighbour : unlessNearer;
        differences[i] = static_cast<Byte>(row[i] - guess);
    }
}

void putHead(std::size_t width, std::size_t height, PngColours colours, Bytes& bytes) {
    constexpr unsigned char kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const unsigned char one : kSignature) bytes.push_back(std::byte{one});
    const std::size_t chunk = beginChunk(bytes, "IHDR");
    putBigEndian(bytes, static_cast<std::uint32_t>(width));
    putBigEndian(bytes, static_cast<std::uint32_t>(height));
    constexpr unsigned char kForm[] = {8, 2, 0, 0, 0};  // bits, RGB, deflate, filters, plain rows
    for (const unsigned char one : kForm) bytes.push_back(std::byte{one});
    endChunk(bytes, chunk);
    if (colours == PngColours::Unsaid)
        return;
    const std::size_t srgb = beginChunk(bytes, "sRGB");
    bytes.push_back(std::byte{0});  // to be shown as people see it best
    endChunk(bytes, srgb);
}

absl::Status checkEncodable(const fabric::Image& image) {
    constexpr std::int64_t kMaxPixels = std::int64_t{1} << 29;
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

PngWriter::PngWriter(int width, int height, PngColours colours)
    : width_(static_cast<std::size_t>(width)),
      height_(static_cast<std::size_t>(height)),
      colours_(colours),
      rowBytes_(1 + kChannels * width_),
      block_(std::clamp<std::size_t>(kBlockBytes / rowBytes_, 1, height_) * rowBytes_ +
             PixelDeflate::kReadBeyond),
      row_(kChannels * width_),
      above_(kChannels * width_) {}

void PngWriter::append(const fabric::Image& rows, Bytes& out) {
    if (rowsDone_ == 0)
        putHead(width_, height_, colours_, out);
    for (auto y = static_cast<std::size_t>(rows.area.height); y-- > 0;) {
        if (y > 0)
            fetch({&rows.colour[(y - 1) * width_], width_});
        filterRow({&rows.colour[y * width_], width_});
        if (++rowsDone_ == height_ ||
            filled_ + rowBytes_ > block_.size() - PixelDeflate::kReadBeyond)
            writeBlock(out);
    }
    if (rowsDone_ == height_)
        endChunk(out, beginChunk(out, "IEND"));
}

void PngWriter::filterRow(std::span<const fabric::Rgba> pixels) {
    row_.swap(above_);
    dropAlpha(pixels, row_.data());
    std::uint8_t* filtered = &block_[filled_];
    filled_ += rowBytes_;
    *filtered++ = kPaeth;
    for (std::size_t i = 0; i < kChannels; ++i)  // left of it is nothing: what is above counts
        filtered[i] = static_cast<std::uint8_t>(row_[i] - above_[i]);
    subtractGuesses(row_, above_.data(), filtered);
}

/// The IDATs together are one zlib stream (RFC 1950).
void PngWriter::writeBlock(Bytes& out) {
    const bool isFirst = rowsDone_ * rowBytes_ == filled_, isLast = rowsDone_ == height_;
    const std::size_t chunk = beginChunk(out, "IDAT");
    if (isFirst)
        for (const int one : {0x78, 1}) out.push_back(std::byte(one));  // 32 kB far; the fastest
    checksum_ = libdeflate_adler32(checksum_, block_.data(), filled_);
    deflate_.append(std::as_bytes(std::span(block_.data(), filled_)), rowBytes_, isLast, out);
    if (isLast)
        putBigEndian(out, checksum_);
    endChunk(out, chunk);
    filled_ = 0;
}

absl::StatusOr<std::vector<std::byte>> encodePng(const fabric::Image& image) {
    RETURN_IF_ERROR(checkEncodable(image));
    Bytes bytes;
    bytes.reserve(image.colour.size() / 2);  // more than most take: moving it costs more than room
    PngWriter writer(image.area.width, image.area.height, PngColours::Unsaid);
    writer.append(image, bytes);
    return bytes;
}

}  // namespace eyrie::wire
