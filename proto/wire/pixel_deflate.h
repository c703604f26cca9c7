// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace eyrie::wire {

/// Deflate (RFC 1951) for the filtered rows of drawn pictures, three bytes a pixel: it looks for
/// what comes again in whole pixels only. Every inflater reads what it writes, and the same rows
/// give the same bytes on every machine. One thread at a time.
///
/// A block refers to nothing before it, so rows need not be in memory longer than their block.
class PixelDeflate {
public:
    static constexpr std::size_t kPixel = 3;
    static constexpr std::size_t kReadBeyond = 8;  ///< bytes after the rows that are read, not used

    /// Appends whole rows, each a byte for its filter and then pixels, as one block to `out`, which
    /// is the same one for all blocks of a stream. Memory of kReadBeyond bytes follows the rows.
    void append(std::span<const std::byte> rows, std::size_t rowBytes, bool isLast,
                std::vector<std::byte>& out);

private:
    static constexpr int kHashBits = 10;
    static constexpr std::size_t kLengthSymbols = 286;
    static constexpr std::size_t kDistanceSymbols = 30;

    /// A token and the bytes it stands for.
    struct Step {
        std::uint32_t token;
        std::size_t bytes;
    };

    void parse(std::span<const std::byte> rows, std::size_t rowBytes);
    Step parsePixel(const std::byte* rows, std::size_t at, std::size_t end);
    Step literals(const std::byte* pixel);
    Step match(std::size_t length, std::size_t distance);
    void write(bool isLast, std::vector<std::byte>& out);

    std::uint64_t bits_ = 0;  ///< those of `out`'s next byte, which is not full yet
    int bitCount_ = 0;
    std::array<std::uint8_t, 256> cost_ = flatCost();  ///< bits a byte took in the block before

    // Of the block at hand.
    std::vector<std::uint32_t> tokens_;
    std::size_t tokenCount_ = 0;
    std::array<std::array<std::uint32_t, 256>, kPixel> channels_;  ///< apart, for counters wait
    std::array<std::uint32_t, kLengthSymbols> lengths_;            ///< with filters and the end
    std::array<std::uint32_t, kDistanceSymbols> distances_;
    std::array<std::uint32_t, std::size_t{1} << kHashBits> lastPlace_;  ///< of two pixels, by hash

    static std::array<std::uint8_t, 256> flatCost();
};

}  // namespace eyrie::wire
