// SPDX-License-Identifier: Apache-2.0
#include "wire/jpeg.h"

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <turbojpeg.h>

#include "fabric/status.h"
#include "wire/jpeg_halves.h"

namespace eyrie::wire {
namespace {

constexpr int kMaxSide = 65500;  // the format's own limit
constexpr std::int64_t kMaxDecodedPixels = std::int64_t{64} << 20;

using Bytes = std::vector<std::byte>;

struct DestroyHandle {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<std::remove_pointer_t<tjhandle>, DestroyHandle>;

/// Keeps its tables between pictures, and is not to be shared.
const Handle& ownDecompressor() {
    thread_local const Handle decompressor(tjInitDecompress());
    return decompressor;
}

std::string_view lastError(const Handle& handle) { return tjGetErrorStr2(handle.get()); }

absl::Status checkEncodable(const fabric::Image& image, int quality) {
    const fabric::PixelViewport& area = image.area;
    if (area.isEmpty() || area.width > kMaxSide || area.height > kMaxSide)
        return absl::InvalidArgumentError(
            fmt::format("jpeg: the image is {}x{} pixels; each side must be 1 to {}", area.width,
                        area.height, kMaxSide));
    if (static_cast<std::int64_t>(image.colour.size()) != area.area())
        return absl::InvalidArgumentError(
            fmt::format("jpeg: the image has {} pixels of colour for an area of {}x{}",
                        image.colour.size(), area.width, area.height));
    if (quality < 1 || quality > 100)
        return absl::InvalidArgumentError(
            fmt::format("jpeg: quality is {}; it must be 1 to 100", quality));
    return absl::OkStatus();
}

/// Rows of `image` from `begin` up to `end`, counted from its bottom, as a picture of their own.
absl::StatusOr<Bytes> encodeRows(const fabric::Image& image, int begin, int end, int quality,
                                 ChromaSubsampling subsampling) {
    // A compressor keeps its tables and buffers between pictures, and is not to be shared.
    thread_local const Handle compressor(tjInitCompress());
    if (compressor == nullptr)
        return absl::ResourceExhaustedError("jpeg: no memory for a compressor");
    const int width = image.area.width;
    const bool isMoving = subsampling == ChromaSubsampling::Half;
    const int format = isMoving ? TJSAMP_420 : TJSAMP_444;
    // The fast transform loses accuracy only at the qualities that still pictures are given.
    const int transform = isMoving ? TJFLAG_FASTDCT : TJFLAG_ACCURATEDCT;
    // Of the room for the worst case a page of memory is touched only where something is written.
    unsigned long size = tjBufSize(width, end - begin, format);
    const auto room = std::make_unique_for_overwrite<std::byte[]>(size);
    auto* destination = reinterpret_cast<unsigned char*>(room.get());
    const fabric::Rgba* const source =
        image.colour.data() + static_cast<std::size_t>(begin) * static_cast<std::size_t>(width);
    if (tjCompress2(compressor.get(), reinterpret_cast<const unsigned char*>(source), width, 0,
                    end - begin, TJPF_RGBA, &destination, &size, format, quality,
                    TJFLAG_BOTTOMUP | TJFLAG_NOREALLOC | transform) != 0)
        return absl::InternalError(fmt::format("jpeg: {}", lastError(compressor)));
    return Bytes(room.get(), room.get() + size);
}

/// Where a picture of `height` rows is cut, counted from its top: at a row of blocks, the upper
/// half the larger one by a row of them at most. Nothing where halves are not worth a thread, or
/// where the upper one has more blocks than the format can count.
std::optional<int> cutOf(int width, int height, ChromaSubsampling subsampling) {
    constexpr int kLeastPixels = 256 * 256;
    constexpr int kMostBlocks = 65535;
    const int side = subsampling == ChromaSubsampling::Half ? 16 : 8;
    const int columns = (width + side - 1) / side;
    const int rows = (height + side - 1) / side;
    const int upper = (rows + 1) / 2;
    if (std::int64_t{width} * height < kLeastPixels || rows < 2 || columns * upper > kMostBlocks)
        return std::nullopt;
    return upper * side;
}

absl::StatusOr<Bytes> encodeHalves(const fabric::Image& image, int cut, int quality,
                                   ChromaSubsampling subsampling) {
    const int height = image.area.height;
    auto encodingLower = std::async(std::launch::async, [&] {
        return encodeRows(image, 0, height - cut, quality, subsampling);
    });
    const absl::StatusOr<Bytes> upper =
        encodeRows(image, height - cut, height, quality, subsampling);
    const absl::StatusOr<Bytes> lower = encodingLower.get();
    if (!upper.ok() || !lower.ok())
        return upper.ok() ? lower.status() : upper.status();
    const int side = subsampling == ChromaSubsampling::Half ? 16 : 8;
    return joined(*upper, *lower, height, (image.area.width + side - 1) / side * (cut / side));
}

}  // namespace

absl::StatusOr<std::vector<std::byte>> encodeJpeg(const fabric::Image& image, int quality,
                                                  ChromaSubsampling subsampling) {
    if (absl::Status status = checkEncodable(image, quality); !status.ok())
        return status;
    const int height = image.area.height;
    if (const std::optional<int> cut = cutOf(image.area.width, height, subsampling))
        return encodeHalves(image, *cut, quality, subsampling);
    return encodeRows(image, 0, height, quality, subsampling);
}

absl::StatusOr<JpegSize> jpegSize(std::span<const std::byte> bytes) {
    const Handle& decompressor = ownDecompressor();
    if (decompressor == nullptr)
        return absl::ResourceExhaustedError("jpeg: no memory for a decompressor");
    JpegSize size;
    int subsampling = 0;
    int colourSpace = 0;
    if (tjDecompressHeader3(decompressor.get(),
                            reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                            &size.width, &size.height, &subsampling, &colourSpace) != 0)
        return absl::InvalidArgumentError(fmt::format("jpeg: {}", lastError(decompressor)));
    return size;
}

absl::StatusOr<fabric::Image> decodeJpeg(std::span<const std::byte> bytes) {
    ASSIGN_OR_RETURN(const JpegSize size, jpegSize(bytes));
    const auto [width, height] = size;
    const Handle& decompressor = ownDecompressor();
    const auto* source = reinterpret_cast<const unsigned char*>(bytes.data());
    if (std::int64_t{width} * height > kMaxDecodedPixels)
        return absl::InvalidArgumentError(
            fmt::format("jpeg: the picture is {}x{}; at most {} pixels are read", width, height,
                        kMaxDecodedPixels));
    fabric::Image image = fabric::makeImage({0, 0, width, height}, fabric::Rgba{}, false);
    if (tjDecompress2(decompressor.get(), source, bytes.size(),
                      reinterpret_cast<unsigned char*>(image.colour.data()), width, 0, height,
                      TJPF_RGBA, TJFLAG_BOTTOMUP | TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING) != 0)
        return absl::InvalidArgumentError(fmt::format("jpeg: {}", lastError(decompressor)));
    return image;
}

}  // namespace eyrie::wire
