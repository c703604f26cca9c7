// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

/// Sixteen integers in as many bits each as the largest needs, lowest first, 2 * bits bytes in all.
/// One function for each number of bits, its shifts known to the compiler, as in D. Lemire and
/// L. Boytsov, "Decoding billions of integers per second through vectorization", 2015 (there for
/// blocks of 32 and 128).
namespace eyrie::wire {

inline constexpr std::size_t kBlockValues = 16;

namespace bit_block {

template <std::size_t Bits, std::size_t... Value>
void pack(const std::uint32_t* values, char* bytes, std::index_sequence<Value...>) {
    // Words of 64 bits; a value that crosses from one to the next is in both.
    std::array<std::uint64_t, 9> words{};
    ((words[Value * Bits / 64] |= std::uint64_t{values[Value]} << (Value * Bits % 64),
      words[Value * Bits / 64 + 1] |=
      Value * Bits % 64 + Bits > 64 ? std::uint64_t{values[Value]} >> (64 - Value * Bits % 64) % 64
                                    : 0),
     ...);
    std::memcpy(bytes, words.data(), 2 * Bits);
}

template <std::size_t Bits, std::size_t... Value>
void unpack(const char* bytes, std::uint32_t* values, std::index_sequence<Value...>) {
    std::array<std::uint64_t, 9> words{};
    std::memcpy(words.data(), bytes, 2 * Bits);
    constexpr std::uint64_t kMask = (std::uint64_t{1} << Bits) - 1;
    ((values[Value] = static_cast<std::uint32_t>(
          ((words[Value * Bits / 64] >> (Value * Bits % 64)) |
           (Value * Bits % 64 + Bits > 64
                ? words[Value * Bits / 64 + 1] << (64 - Value * Bits % 64) % 64
                : 0)) &
          kMask)),
     ...);
}

template <std::size_t Bits>
void packBits(const std::uint32_t* values, char* bytes) {
    pack<Bits>(values, bytes, std::make_index_sequence<kBlockValues>());
}

template <std::size_t Bits>
void unpackBits(const char* bytes, std::uint32_t* values) {
    unpack<Bits>(bytes, values, std::make_index_sequence<kBlockValues>());
}

template <std::size_t... Bits>
constexpr auto packers(std::index_sequence<Bits...>) {
    return std::array{&packBits<Bits>...};
}

template <std::size_t... Bits>
constexpr auto unpackers(std::index_sequence<Bits...>) {
    return std::array{&unpackBits<Bits>...};
}

inline constexpr auto kPackers = packers(std::make_index_sequence<33>());
inline constexpr auto kUnpackers = unpackers(std::make_index_sequence<33>());

}  // namespace bit_block

/// Writes 2 * bits bytes. Precondition: bits <= 32 and no value has more.
inline void packBlock(const std::uint32_t* values, unsigned bits, char* bytes) {
    bit_block::kPackers[bits](values, bytes);
}

/// Reads 2 * bits bytes. Precondition: bits <= 32.
inline void unpackBlock(const char* bytes, unsigned bits, std::uint32_t* values) {
    bit_block::kUnpackers[bits](bytes, values);
}

}  // namespace eyrie::wire
