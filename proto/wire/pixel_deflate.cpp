// SPDX-License-Identifier: Apache-2.0
// P. Deutsch, "DEFLATE Compressed Data Format Specification", RFC 1951, 1996.
#include "wire/pixel_deflate.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "wire/prefix_code.h"

namespace eyrie::wire {
namespace {

constexpr std::size_t kPixel = PixelDeflate::kPixel;
constexpr std::size_t kFarthest = 32768;
constexpr std::size_t kLongestMatch = 258;
static_assert(kLongestMatch % kPixel == 0);
constexpr int kLongestCode = 15;
constexpr std::size_t kEndOfBlock = 256;
/// Two pixels of so many bits each take more than the match they could be, and its two codes with
/// their further bits some 23. Pictures of colours have cheaper ones, which want to be left as they
/// are: 9 makes the demo's picture 7 % larger. Those of grey have dear ones, and 14 does for them.
constexpr int kDearPixel = 12;

// A token is three literals, the first one lowest, unless one of these says otherwise.
constexpr std::uint32_t kMatchToken = 1u << 31;   // 15 bits: distance - 1; above them pixels
constexpr std::uint32_t kFilterToken = 1u << 30;  // the lowest byte alone

/// A length's or a distance's symbol, and what follows that.
struct Symbol {
    std::size_t number;
    int furtherBits;
    std::uint32_t further;
};

/// Both kinds have symbols in groups of 2^`groupBits`, each of which is twice as wide as the one
/// before from the third one on.
constexpr Symbol symbolOf(std::uint32_t value, int groupBits) {
    const int width = std::bit_width(value);
    const int furtherBits = std::max(width - 1 - groupBits, 0);
    const std::uint32_t high = value >> furtherBits;
    return {(static_cast<std::size_t>(furtherBits) << groupBits) + high, furtherBits,
            value - (high << furtherBits)};
}

constexpr Symbol lengthSymbol(std::size_t length) {
    if (length == kLongestMatch)
        return {285, 0, 0};
    Symbol symbol = symbolOf(static_cast<std::uint32_t>(length - 3), 2);
    symbol.number += kEndOfBlock + 1;
    return symbol;
}

constexpr Symbol distanceSymbol(std::size_t distance) {
    return symbolOf(static_cast<std::uint32_t>(distance - 1), 1);
}
static_assert(lengthSymbol(12).number == 265 && lengthSymbol(257).number == 284);
static_assert(distanceSymbol(3).number == 2 && distanceSymbol(32768).number == 29);

std::uint64_t eightBytes(const std::byte* at) {
    static_assert(std::endian::native == std::endian::little);
    std::uint64_t bytes;
    std::memcpy(&bytes, at, sizeof bytes);
    return bytes;
}

/// How many bytes agree, `most` at most. Reads up to 7 beyond those.
std::size_t agreeing(const std::byte* one, const std::byte* other, std::size_t most) {
    for (std::size_t i = 0; i < most; i += 8)
        if (const std::uint64_t differs = eightBytes(one + i) ^ eightBytes(other + i); differs != 0)
            return std::min(most, i + static_cast<std::size_t>(std::countr_zero(differs)) / 8);
    return most;
}

/// How long a match of whole pixels is, from a place that is `distance` before.
std::size_t matched(const std::byte* at, std::size_t distance, std::size_t left) {
    const std::size_t same = agreeing(at, at - distance, std::min(left, kLongestMatch));
    return same - same % kPixel;
}

/// Bits from the lowest of each byte on. By value where it is used much: what it writes could
/// otherwise be itself, as far as the compiler knows.
struct BitWriter {
    std::uint64_t bits;
    int count;
    std::byte* to;

    /// At most 56 at a time. Up to 8 bytes from `to` on are written over.
    void put(std::uint64_t more, int moreCount) {
        bits |= more << count;
        count += moreCount;
        std::memcpy(to, &bits, sizeof bits);
        to += count / 8;
        bits >>= count & ~7;
        count &= 7;
    }
};

/// The codes of one alphabet.
struct Code {
    explicit Code(std::span<const std::uint32_t> counts, int longest = kLongestCode)
        : lengths(codeLengths(counts, longest)), codes(codesOf(lengths)) {}

    std::uint64_t bits(std::size_t symbol) const { return codes[symbol]; }
    int length(std::size_t symbol) const { return lengths[symbol]; }

    std::vector<std::uint8_t> lengths;
    std::vector<std::uint16_t> codes;
};

/// The lengths of both codes as deflate tells them: each a symbol, but many zeros in one.
std::vector<Symbol> told(std::vector<std::uint8_t> lengths, const Code& distances) {
    lengths.insert(lengths.end(), distances.lengths.begin(), distances.lengths.end());
    std::vector<Symbol> symbols;
    for (std::size_t i = 0; i < lengths.size();) {
        std::size_t zeros = 0;
        while (zeros < 138 && i + zeros < lengths.size() && lengths[i + zeros] == 0) ++zeros;
        if (zeros >= 11)
            symbols.push_back({18, 7, static_cast<std::uint32_t>(zeros - 11)});
        else if (zeros >= 3)
            symbols.push_back({17, 3, static_cast<std::uint32_t>(zeros - 3)});
        else
            symbols.push_back({lengths[i], 0, 0});
        i += zeros >= 3 ? zeros : 1;
    }
    return symbols;
}

void putHead(const Code& lengths, const Code& distances, bool isLast, BitWriter& writer) {
    constexpr std::array<std::size_t, 19> kOrder{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                 11, 4,  12, 3, 13, 2, 14, 1, 15};
    const std::vector<Symbol> symbols = told(lengths.lengths, distances);
    std::array<std::uint32_t, kOrder.size()> counts{};
    for (const Symbol& symbol : symbols) ++counts[symbol.number];
    const Code code(counts, 7);
    writer.put(isLast ? 1 : 0, 1);
    writer.put(2, 2);  // codes of its own
    writer.put(lengths.lengths.size() - 257, 5);
    writer.put(distances.lengths.size() - 1, 5);
    writer.put(kOrder.size() - 4, 4);
    for (const std::size_t symbol : kOrder)
        writer.put(static_cast<std::uint64_t>(code.length(symbol)), 3);
    for (const Symbol& symbol : symbols) {
        writer.put(code.bits(symbol.number), code.length(symbol.number));
        writer.put(symbol.further, symbol.furtherBits);
    }
}

void putTokens(std::span<const std::uint32_t> tokens, const Code& lengths, const Code& distances,
               BitWriter& asked) {
    struct Entry {
        std::uint32_t bits;
        int length;
    };
    std::array<Entry, 256> literals;
    for (std::size_t i = 0; i < literals.size(); ++i)
        literals[i] = {lengths.codes[i], lengths.lengths[i]};
    BitWriter writer = asked;
    for (const std::uint32_t token : tokens) {
        if ((token & kMatchToken) != 0) {
            const Symbol length = lengthSymbol((token >> 15 & 0xff) * kPixel);
            const Symbol distance = distanceSymbol((token & 0x7fff) + 1);
            writer.put(lengths.bits(length.number), lengths.length(length.number));
            writer.put(length.further, length.furtherBits);
            writer.put(distances.bits(distance.number), distances.length(distance.number));
            writer.put(distance.further, distance.furtherBits);
        } else if ((token & kFilterToken) != 0) {
            writer.put(literals[token & 0xff].bits, literals[token & 0xff].length);
        } else {
            const Entry one = literals[token & 0xff], two = literals[token >> 8 & 0xff],
                        three = literals[token >> 16];
            writer.put(one.bits | std::uint64_t{two.bits} << one.length |
                           std::uint64_t{three.bits} << (one.length + two.length),
                       one.length + two.length + three.length);
        }
    }
    writer.put(lengths.bits(kEndOfBlock), lengths.length(kEndOfBlock));
    asked = writer;
}

/// What the symbols of one alphabet take, without what follows them.
std::size_t bitsOf(std::span<const std::uint32_t> counts, const Code& code) {
    std::size_t bits = 0;
    for (std::size_t i = 0; i < counts.size(); ++i)
        bits += std::size_t{counts[i]} * code.lengths[i];
    return bits;
}

}  // namespace

std::array<std::uint8_t, 256> PixelDeflate::flatCost() {
    std::array<std::uint8_t, 256> cost;
    cost.fill(4);
    return cost;
}

void PixelDeflate::append(std::span<const std::byte> rows, std::size_t rowBytes, bool isLast,
                          std::vector<std::byte>& out) {
    parse(rows, rowBytes);
    write(isLast, out);
}

void PixelDeflate::parse(std::span<const std::byte> rows, std::size_t rowBytes) {
    tokens_.resize(std::max(tokens_.size(), rows.size() / kPixel + rows.size() / rowBytes));
    for (auto& channel : channels_) channel.fill(0);
    lengths_.fill(0);
    distances_.fill(0);
    // So far from everywhere that it is no match's distance.
    lastPlace_.fill(static_cast<std::uint32_t>(rows.size() + kFarthest));
    std::uint32_t* token = tokens_.data();
    for (std::size_t row = 0; row < rows.size(); row += rowBytes) {
        const auto filter = static_cast<std::uint8_t>(rows[row]);
        *token++ = kFilterToken | filter;
        ++lengths_[filter];
        for (std::size_t at = row + 1; at < row + rowBytes;) {
            const Step step = parsePixel(rows.data(), at, row + rowBytes);
            *token++ = step.token;
            at += step.bytes;
        }
    }
    ++lengths_[kEndOfBlock];
    tokenCount_ = static_cast<std::size_t>(token - tokens_.data());
}

PixelDeflate::Step PixelDeflate::parsePixel(const std::byte* rows, std::size_t at,
                                            std::size_t end) {
    const std::size_t left = end - at;
    if (left < 2 * kPixel)
        return literals(rows + at);
    constexpr std::uint64_t kTwoPixels = (std::uint64_t{1} << 48) - 1;
    const std::uint64_t two = eightBytes(rows + at) & kTwoPixels;
    if (at >= kPixel && two == (eightBytes(rows + at - kPixel) & kTwoPixels))
        return match(matched(rows + at, kPixel, left), kPixel);
    if (cost_[two & 0xff] + cost_[two >> 8 & 0xff] + cost_[two >> 16 & 0xff] < kDearPixel)
        return literals(rows + at);
    std::uint32_t& last = lastPlace_[two * 0x9e3779b97f4a7c15u >> (64 - kHashBits)];
    const std::uint32_t distance = static_cast<std::uint32_t>(at) - last;
    last = static_cast<std::uint32_t>(at);
    if (distance - 1 < kFarthest && two == (eightBytes(rows + at - distance) & kTwoPixels))
        return match(matched(rows + at, distance, left), distance);
    return literals(rows + at);
}

PixelDeflate::Step PixelDeflate::literals(const std::byte* pixel) {
    std::uint32_t token = 0;
    for (std::size_t i = 0; i < kPixel; ++i) {
        const auto literal = static_cast<std::uint8_t>(pixel[i]);
        ++channels_[i][literal];
        token |= std::uint32_t{literal} << 8 * i;
    }
    return {token, kPixel};
}

PixelDeflate::Step PixelDeflate::match(std::size_t length, std::size_t distance) {
    ++lengths_[lengthSymbol(length).number];
    ++distances_[distanceSymbol(distance).number];
    return {kMatchToken | static_cast<std::uint32_t>(length / kPixel) << 15 |
                static_cast<std::uint32_t>(distance - 1),
            length};
}

void PixelDeflate::write(bool isLast, std::vector<std::byte>& out) {
    for (const auto& channel : channels_)
        for (std::size_t i = 0; i < channel.size(); ++i) lengths_[i] += channel[i];
    const auto matches = std::accumulate(distances_.begin(), distances_.end(), std::size_t{0});
    // A code of nothing is not known to all inflaters.
    if (matches == 0)
        ++distances_[0];
    const Code lengths(lengths_), distances(distances_);
    constexpr std::size_t kMostHeadBits = 17 + 19 * 3 + (286 + 30) * (7 + 7);
    constexpr std::size_t kMostFurtherBits = 5 + 13;
    const std::size_t mostBits = kMostHeadBits + bitsOf(lengths_, lengths) +
                                 bitsOf(distances_, distances) + kMostFurtherBits * matches;
    const std::size_t begin = out.size();
    out.resize(begin + mostBits / 8 + 2 * sizeof bits_);
    BitWriter writer{bits_, bitCount_, out.data() + begin};
    putHead(lengths, distances, isLast, writer);
    putTokens({tokens_.data(), tokenCount_}, lengths, distances, writer);
    if (isLast)
        writer.put(0, (8 - writer.count) % 8);
    bits_ = writer.bits;
    bitCount_ = writer.count;
    out.resize(static_cast<std::size_t>(writer.to - out.data()));
    constexpr std::uint8_t kCostOfUnseen = 12;
    for (std::size_t i = 0; i < cost_.size(); ++i)
        cost_[i] = lengths.lengths[i] == 0 ? kCostOfUnseen : lengths.lengths[i];
}

}  // namespace eyrie::wire
