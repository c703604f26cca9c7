// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/codec/exact_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "renderer/codec/bits.h"
#include "renderer/codec/rans.h"
#include "renderer/codec/symbol_shares.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr std::uint32_t kWidths = 65;  ///< bits that a number may have

/// Consecutive numbers of the form have consecutive places.
std::uint64_t placeOf(double value, ExactForm form) {
    if (form == ExactForm::Float32) {
        const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
        return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
    }
    const auto bits = std::bit_cast<std::uint64_t>(value);
    return (bits >> 63) != 0 ? ~bits : bits | std::uint64_t{1} << 63;
}

double valueAt(std::uint64_t place, ExactForm form) {
    if (form == ExactForm::Float32) {
        const auto bits = static_cast<std::uint32_t>(place);
        return static_cast<double>(
            std::bit_cast<float>((bits & 0x80000000U) != 0 ? bits & 0x7FFFFFFFU : ~bits));
    }
    const std::uint64_t sign = std::uint64_t{1} << 63;
    return std::bit_cast<double>((place & sign) != 0 ? place & ~sign : ~place);
}

std::uint64_t zigzag64(std::uint64_t difference) {
    return difference << 1 ^ (0 - (difference >> 63));
}
std::uint64_t unzigzag64(std::uint64_t code) { return code >> 1 ^ (0 - (code & 1)); }

/// Without its highest bit, which the width tells.
void putRest(codec::BitWriter& writer, std::uint64_t number, int width) {
    const std::uint64_t rest = width == 0 ? 0 : number ^ std::uint64_t{1} << (width - 1);
    const int bits = std::max(width - 1, 0);
    writer.put(static_cast<std::uint32_t>(rest), std::min(bits, 32));
    if (bits > 32)
        writer.put(static_cast<std::uint32_t>(rest >> 32), bits - 32);
}

std::uint64_t getNumber(codec::BitReader& reader, int width) {
    if (width == 0)
        return 0;
    std::uint64_t rest = reader.get(std::min(width - 1, 32));
    if (width > 33)
        rest |= std::uint64_t{reader.get(width - 33)} << 32;
    return rest | std::uint64_t{1} << (width - 1);
}

absl::Status damaged() { return absl::DataLossError("its page of source positions is damaged"); }

}  // namespace

ExactForm exactFormOf(std::span<const fabric::Vec3> positions) {
    for (const fabric::Vec3& position : positions)
        for (int axis = 0; axis < 3; ++axis)
            if (static_cast<double>(static_cast<float>(position[axis])) != position[axis])
                return ExactForm::Float64;
    return ExactForm::Float32;
}

std::vector<std::byte> encodeExact(std::span<const fabric::Vec3> exact,
                                   std::span<const std::uint64_t> onLattice, const Lattice& lattice,
                                   ExactForm form) {
    std::array<std::array<std::uint32_t, kWidths>, 3> counts{};
    std::vector<std::uint64_t> numbers;
    numbers.reserve(exact.size() * 3);
    for (std::size_t v = 0; v < exact.size(); ++v) {
        const fabric::Vec3 near = lattice.metres(unpackPosition(onLattice[v]));
        for (int axis = 0; axis < 3; ++axis) {
            std::uint64_t left = placeOf(exact[v][axis], form) - placeOf(near[axis], form);
            if (form == ExactForm::Float32)  // modulo 2^32
                left = static_cast<std::uint64_t>(
                    static_cast<std::int64_t>(static_cast<std::int32_t>(left)));
            numbers.push_back(zigzag64(left));
            ++counts[static_cast<std::size_t>(axis)]
                    [static_cast<std::size_t>(std::bit_width(numbers.back()))];
        }
    }
    codec::BitWriter writer;
    std::vector<codec::SymbolShares> shares;
    for (const auto& count : counts) {
        shares.emplace_back(count);
        shares.back().write(writer);
    }
    for (const std::uint64_t number : numbers)
        putRest(writer, number, static_cast<int>(std::bit_width(number)));
    codec::RansEncoder<4> rans;
    for (std::size_t k = numbers.size(); k-- > 0;)
        rans.put(k % 4, shares[k % 3].of(static_cast<std::uint32_t>(std::bit_width(numbers[k]))),
                 codec::kSymbolBits);
    std::vector<std::uint8_t> bits = std::move(writer).finish();
    bits.resize(bits.size() + bits.size() % 2);
    const std::vector<std::uint16_t> words = std::move(rans).finish();
    const auto bitBytes = static_cast<std::uint32_t>(bits.size());
    std::vector<std::byte> page(sizeof bitBytes + bits.size() + words.size() * 2);
    std::memcpy(page.data(), &bitBytes, sizeof bitBytes);
    std::memcpy(page.data() + sizeof bitBytes, bits.data(), bits.size());
    std::memcpy(page.data() + sizeof bitBytes + bits.size(), words.data(), words.size() * 2);
    return page;
}

absl::StatusOr<std::vector<fabric::Vec3>> decodeExact(std::span<const std::byte> page,
                                                      std::span<const std::uint64_t> onLattice,
                                                      const Lattice& lattice, ExactForm form) {
    std::uint32_t bitBytes = 0;
    if (page.size() < sizeof bitBytes || page.size() % 2 != 0)
        return damaged();
    std::memcpy(&bitBytes, page.data(), sizeof bitBytes);
    if (bitBytes % 2 != 0 || bitBytes > page.size() - sizeof bitBytes)
        return damaged();
    codec::BitReader reader(
        {reinterpret_cast<const std::uint8_t*>(page.data()) + sizeof bitBytes, bitBytes});
    std::vector<std::uint32_t> slots(3 * codec::kAllShares);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        codec::SymbolShares shares;
        if (!shares.read(reader, kWidths))
            return damaged();
        shares.fillSlots(std::span<std::uint32_t, codec::kAllShares>(
            slots.data() + axis * codec::kAllShares, std::size_t{codec::kAllShares}));
    }
    const std::size_t first = sizeof bitBytes + bitBytes;
    std::vector<std::uint16_t> words((page.size() - first) / 2);
    std::memcpy(words.data(), page.data() + first, words.size() * 2);
    codec::RansDecoder<4> rans(words);
    std::vector<fabric::Vec3> exact(onLattice.size());
    std::size_t k = 0;
    for (std::size_t v = 0; v < exact.size(); ++v) {
        const fabric::Vec3 near = lattice.metres(unpackPosition(onLattice[v]));
        for (int axis = 0; axis < 3; ++axis, ++k) {
            const codec::SlotEntry entry{
                slots[(k % 3 << codec::kSymbolBits) + rans.slot(k % 4, codec::kSymbolBits)]};
            rans.take(k % 4, entry, codec::kSymbolBits);
            const std::uint64_t left =
                unzigzag64(getNumber(reader, static_cast<int>(entry.symbol())));
            exact[v][axis] = valueAt(placeOf(near[axis], form) + left, form);
            if (!std::isfinite(exact[v][axis]))
                return damaged();
        }
    }
    if (!rans.isAtEnd() || reader.isPastEnd())
        return damaged();
    return exact;
}

}  // namespace eyrie::mesh
