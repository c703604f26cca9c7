// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/sgi_image.h"

#include <algorithm>
#include <cstdint>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

constexpr std::size_t kHeaderBytes = 512;

/// The file's numbers, the high byte first. Beyond its end there are zeros.
class Bytes {
public:
    explicit Bytes(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::size_t size() const { return bytes_.size(); }
    std::uint8_t byte(std::size_t at) const {
        return at < bytes_.size() ? std::to_integer<std::uint8_t>(bytes_[at]) : std::uint8_t{0};
    }
    std::uint32_t word(std::size_t at) const { return byte(at) * 256U + byte(at + 1); }
    std::uint32_t longWord(std::size_t at) const { return word(at) << 16 | word(at + 2); }

private:
    std::span<const std::byte> bytes_;
};

/// A run of bytes is told by its length and, in the highest bit, whether all of them follow; a
/// length of 0 ends the row. False where the row is not filled.
bool decodeRow(const Bytes& file, std::size_t at, std::span<std::uint8_t> row) {
    std::size_t filled = 0;
    while (filled < row.size() && at < file.size()) {
        const std::uint8_t code = file.byte(at++);
        const std::size_t count = code & 127U;
        if (count == 0 || count > row.size() - filled)
            return false;
        const bool isCopied = code > 127;
        for (std::size_t k = 0; k < count; ++k) row[filled++] = file.byte(isCopied ? at + k : at);
        at += isCopied ? count : 1;
    }
    return filled == row.size() && at <= file.size();
}

std::uint32_t channelsOf(const Bytes& file) { return file.word(4) < 3 ? 1 : file.word(10); }

void setChannel(fabric::Rgba& texel, std::uint32_t channel, std::uint32_t channels,
                std::uint8_t value) {
    if (channels < 3 && channel == 0)
        texel = {value, value, value, 255};
    else if (channels < 3 || channel == 3)
        texel.a = value;
    else
        (channel == 0 ? texel.r : channel == 1 ? texel.g : texel.b) = value;
}

}  // namespace

bool looksLikeSgi(std::span<const std::byte> bytes) {
    return bytes.size() >= kHeaderBytes && Bytes(bytes).word(0) == 0x01DA;
}

absl::StatusOr<mesh::ImageShape> sgiShapeOf(std::span<const std::byte> bytes) {
    const Bytes file(bytes);
    mesh::ImageShape shape;
    shape.width = file.word(6);
    shape.height = file.word(4) < 2 ? 1 : file.word(8);
    const std::uint32_t channels = channelsOf(file);
    if (file.byte(3) != 1 || channels < 1 || channels > 4 || shape.width < 1 || shape.height < 1 ||
        shape.width > mesh::kMaxImageSide || shape.height > mesh::kMaxImageSide)
        return absl::InvalidArgumentError(fmt::format(
            "has {} x {} texels of {} channels of {} bytes, expected at most {} a side, "
            "4 and 1",
            shape.width, shape.height, channels, file.byte(3), mesh::kMaxImageSide));
    return shape;
}

absl::StatusOr<std::vector<fabric::Rgba>> decodeSgi(std::span<const std::byte> bytes,
                                                    mesh::ImageShape& shape) {
    ASSIGN_OR_RETURN(shape, sgiShapeOf(bytes));
    const Bytes file(bytes);
    const bool isCoded = file.byte(2) != 0;
    const std::uint32_t channels = channelsOf(file);
    const std::size_t rows = std::size_t{shape.height} * channels;
    if (kHeaderBytes + rows * (isCoded ? 9 : shape.width) > file.size())
        return absl::InvalidArgumentError("is truncated");
    std::vector<fabric::Rgba> texels(std::size_t{shape.width} * shape.height,
                                     fabric::Rgba{0, 0, 0, 255});
    std::vector<std::uint8_t> row(shape.width);
    for (std::size_t k = 0; k < rows; ++k) {
        const std::size_t plain = kHeaderBytes + k * shape.width;
        for (std::size_t x = 0; x < row.size() && !isCoded; ++x) row[x] = file.byte(plain + x);
        if (isCoded && !decodeRow(file, file.longWord(kHeaderBytes + 4 * k), row))
            return absl::InvalidArgumentError(fmt::format("is damaged in row {}", k));
        const std::size_t y = shape.height - 1 - k % shape.height;  // from the bottom
        for (std::size_t x = 0; x < row.size(); ++x)
            setChannel(texels[y * shape.width + x], static_cast<std::uint32_t>(k / shape.height),
                       channels, row[x]);
    }
    return texels;
}

}  // namespace eyrie::import
