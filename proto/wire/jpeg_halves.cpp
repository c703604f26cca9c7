// SPDX-License-Identifier: Apache-2.0
// Markers and segments: ITU-T T.81 (JPEG), annex B.
#include "wire/jpeg_halves.h"

#include <array>
#include <optional>

namespace eyrie::wire {
namespace {

constexpr std::byte kMarker{0xFF};
constexpr std::byte kFrame{0xC0};          ///< SOF0: a baseline picture's size and components
constexpr std::byte kScan{0xDA};           ///< SOS: coded blocks follow
constexpr std::byte kEnd{0xD9};            ///< EOI
constexpr std::byte kRestart{0xD0};        ///< RST0
constexpr std::byte kRestartEvery{0xDD};   ///< DRI
constexpr std::size_t kMarkerBytes = 2;    ///< 0xFF and which it is
constexpr std::size_t kHeightInFrame = 5;  ///< behind marker, length and precision

std::byte high(int value) { return static_cast<std::byte>(value >> 8); }
std::byte low(int value) { return static_cast<std::byte>(value & 0xFF); }

/// What comes before the coded blocks, and they.
struct Parts {
    std::size_t frame = 0;  ///< where this segment begins
    std::size_t scan = 0;   ///< and that
    std::span<const std::byte> head;
    std::span<const std::byte> coded;
};

std::optional<Parts> partsOf(std::span<const std::byte> jpeg) {
    Parts parts;
    for (std::size_t at = kMarkerBytes; at + 4 <= jpeg.size() && jpeg[at] == kMarker;) {
        const std::byte kind = jpeg[at + 1];
        const std::size_t length = std::to_integer<std::size_t>(jpeg[at + 2]) << 8 |
                                   std::to_integer<std::size_t>(jpeg[at + 3]);
        const std::size_t next = at + kMarkerBytes + length;
        if (next + kMarkerBytes > jpeg.size())
            return std::nullopt;
        if (kind == kFrame)
            parts.frame = at;
        if (kind == kScan) {
            parts.scan = at;
            parts.head = jpeg.first(next);
            parts.coded = jpeg.subspan(next, jpeg.size() - kMarkerBytes - next);
            const auto end = jpeg.last(kMarkerBytes);
            const bool isWhole = end[0] == kMarker && end[1] == kEnd;
            return parts.frame > 0 && isWhole ? std::optional(parts) : std::nullopt;
        }
        at = next;
    }
    return std::nullopt;
}

void setHeight(std::span<std::byte> head, std::size_t frame, int height) {
    head[frame + kHeightInFrame] = high(height);
    head[frame + kHeightInFrame + 1] = low(height);
}

}  // namespace

absl::StatusOr<std::vector<std::byte>> joined(std::span<const std::byte> upper,
                                              std::span<const std::byte> lower, int height,
                                              int blocks) {
    const std::optional<Parts> first = partsOf(upper);
    const std::optional<Parts> second = partsOf(lower);
    if (!first || !second)
        return absl::InvalidArgumentError("jpeg: a half is no baseline picture of one scan");
    std::vector<std::byte> head(first->head.begin(), first->head.end());
    std::vector<std::byte> other(second->head.begin(), second->head.end());
    setHeight(head, first->frame, height);
    setHeight(other, second->frame, height);
    if (head != other)
        return absl::InvalidArgumentError("jpeg: the halves were made by different tables");
    constexpr std::byte kNone{0};
    const std::byte interval[] = {kMarker,      kRestartEvery, kNone,
                                  std::byte{4}, high(blocks),  low(blocks)};
    head.insert(head.begin() + static_cast<std::ptrdiff_t>(first->scan), std::begin(interval),
                std::end(interval));
    std::vector<std::byte> jpeg;
    jpeg.reserve(head.size() + first->coded.size() + second->coded.size() + 2 * kMarkerBytes);
    const auto put = [&jpeg](std::span<const std::byte> bytes) {
        jpeg.insert(jpeg.end(), bytes.begin(), bytes.end());
    };
    put(head);
    put(first->coded);
    put(std::array{kMarker, kRestart});
    put(second->coded);
    put(std::array{kMarker, kEnd});
    return jpeg;
}

}  // namespace eyrie::wire
