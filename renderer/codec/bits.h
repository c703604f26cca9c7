// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace eyrie::codec {

/// Appends numbers of 0 to 32 bits, lowest bit first.
class BitWriter {
public:
    /// Precondition: value < 2^bits.
    void put(std::uint32_t value, int bits) {
        pending_ |= std::uint64_t{value} << count_;
        count_ += bits;
        for (; count_ >= 8; count_ -= 8, pending_ >>= 8)
            bytes_.push_back(static_cast<std::uint8_t>(pending_));
    }

    /// Elias' gamma code: few bits for small numbers. Precondition: 0 < value < 2^31.
    void putGamma(std::uint32_t value) {
        const int bits = std::bit_width(value);
        put(0, bits - 1);
        put(1, 1);
        put(value ^ 1U << (bits - 1), bits - 1);
    }

    std::vector<std::uint8_t> finish() && {
        put(0, (8 - count_) & 7);
        return std::move(bytes_);
    }

private:
    std::vector<std::uint8_t> bytes_;
    std::uint64_t pending_ = 0;
    int count_ = 0;
};

/// Reads them back. Past the end there are zeros; isPastEnd() then says so.
class BitReader {
public:
    explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::uint32_t get(int bits) {
        const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
        const std::uint64_t value = load() >> (position_ & 7) & mask;
        position_ += static_cast<std::size_t>(bits);
        return static_cast<std::uint32_t>(value);
    }

    /// 0 where there is none: no such number is written.
    std::uint32_t getGamma() {
        int bits = 0;
        while (get(1) == 0)
            if (++bits > 30)
                return 0;
        return get(bits) | 1U << bits;
    }

    std::size_t size() const { return bytes_.size(); }
    std::size_t bytesRead() const { return (position_ + 7) / 8; }
    bool isPastEnd() const { return bytesRead() > bytes_.size(); }

private:
    std::uint64_t load() const {
        const std::size_t at = position_ / 8;
        std::uint64_t value = 0;
        if (at + sizeof value <= bytes_.size()) [[likely]]
            std::memcpy(&value, bytes_.data() + at, sizeof value);
        else if (at < bytes_.size())
            std::memcpy(&value, bytes_.data() + at, bytes_.size() - at);
        return value;
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t position_ = 0;  ///< in bits
};

}  // namespace eyrie::codec
