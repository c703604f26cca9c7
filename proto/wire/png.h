// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/image.h"
#include "wire/pixel_deflate.h"

namespace eyrie::wire {

/// The colour of `image` as a PNG of 8 bits a channel, upright (the image's top row comes first):
/// red, green and blue come back bit for bit. Alpha and depth are left out, and nothing is said of
/// colour spaces, so that no browser converts anything. May be called from any thread.
///
/// Made for speed: 1280x720 of terrain takes some 2.4 ms on one core (docs/benchmarks/viewing.md).
/// The same image gives the same bytes on every machine.
/// Errors: InvalidArgument (an empty image, or colour that does not fill the area).
absl::StatusOr<std::vector<std::byte>> encodePng(const fabric::Image& image);

/// What a PNG says of its colours: nothing, or that they are sRGB's.
enum class PngColours { Unsaid, Srgb };

/// The same from the top down, for a picture that is never in memory whole. One thread at a time.
class PngWriter {
public:
    /// Precondition: a picture of one pixel at least.
    PngWriter(int width, int height, PngColours colours);

    /// Appends to `out` what the next rows down complete of the file: its head with the first, its
    /// end with the last. Precondition: `rows` is as wide as the picture, and its colour fills it.
    void append(const fabric::Image& rows, std::vector<std::byte>& out);

private:
    void filterRow(std::span<const fabric::Rgba> pixels);
    void writeBlock(std::vector<std::byte>& out);

    const std::size_t width_, height_;
    const PngColours colours_;
    const std::size_t rowBytes_;             ///< a byte for the filter, and pixels
    std::vector<std::uint8_t> block_;        ///< filtered rows that are to be compressed together
    std::size_t filled_ = 0;                 ///< bytes of it
    std::vector<std::uint8_t> row_, above_;  ///< without alpha; zeros before the first one
    std::size_t rowsDone_ = 0;
    std::uint32_t checksum_ = 1;
    PixelDeflate deflate_;
};

}  // namespace eyrie::wire
