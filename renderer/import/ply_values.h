// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "renderer/import/ply_header.h"

/// The values of a PLY body one after another, the same interface for text and binary. Every read
/// returns false, and moves no further, where the bytes end or are no such value.
namespace eyrie::import {

static_assert(std::endian::native == std::endian::little, "BinaryValues<false> reads as stored");

/// Binary values; `kSwapped` for the other byte order.
template <bool kSwapped>
class BinaryValues {
public:
    explicit BinaryValues(std::string_view body)
        : begin_(body.data()), at_(begin_), end_(begin_ + body.size()) {}

    bool number(PlyType type, double& value) {
        switch (type) {
            case PlyType::Float32:
                return readAs<float>(value);
            case PlyType::Float64:
                return readAs<double>(value);
            default: {
                std::int64_t whole = 0;
                if (!integer(type, whole))
                    return false;
                value = static_cast<double>(whole);
                return true;
            }
        }
    }

    /// Precondition: isInteger(type).
    bool integer(PlyType type, std::int64_t& value) {
        switch (type) {
            case PlyType::Int8:
                return readAs<std::int8_t>(value);
            case PlyType::UInt8:
                return readAs<std::uint8_t>(value);
            case PlyType::Int16:
                return readAs<std::int16_t>(value);
            case PlyType::UInt16:
                return readAs<std::uint16_t>(value);
            case PlyType::Int32:
                return readAs<std::int32_t>(value);
            case PlyType::UInt32:
                return readAs<std::uint32_t>(value);
            default:
                return false;
        }
    }

    bool skip(PlyType type, std::uint64_t count) {
        if (!mayHold(type, count))
            return false;
        at_ += count * sizeBytes(type);
        return true;
    }

    /// Whether the bytes that are left could be `count` values.
    bool mayHold(PlyType type, std::uint64_t count) const {
        return count <= bytesLeft() / sizeBytes(type);
    }

    /// Whether nothing but what files are filled up with is left: line breaks, zeros.
    bool atEnd() const {
        return std::all_of(at_, end_, [](char c) { return c == '\0' || c == '\n' || c == '\r'; });
    }
    std::uint64_t bytesLeft() const { return static_cast<std::uint64_t>(end_ - at_); }
    std::uint64_t offset() const { return static_cast<std::uint64_t>(at_ - begin_); }

private:
    template <typename Stored, typename Value>
    bool readAs(Value& value) {
        if (bytesLeft() < sizeof(Stored))
            return false;
        std::array<char, sizeof(Stored)> bytes;
        std::memcpy(bytes.data(), at_, sizeof(Stored));
        if constexpr (kSwapped)
            std::reverse(bytes.begin(), bytes.end());
        value = static_cast<Value>(+std::bit_cast<Stored>(bytes));  // + : a char is a number here
        at_ += sizeof(Stored);
        return true;
    }

    const char* begin_;
    const char* at_;
    const char* end_;
};

/// Values as text, parted by white space; line breaks mean nothing more.
class AsciiValues {
public:
    explicit AsciiValues(std::string_view body)
        : begin_(body.data()), at_(begin_), end_(begin_ + body.size()) {}

    /// The nearest double or, for Float32, the float nearest to that: what a binary file holds.
    bool number(PlyType type, double& value);
    /// Decimal digits, perhaps after a sign.
    bool integer(PlyType type, std::int64_t& value);
    bool skip(PlyType type, std::uint64_t count);

    bool mayHold(PlyType, std::uint64_t count) const { return count <= (bytesLeft() + 1) / 2; }

    /// Whether nothing but white space is left.
    bool atEnd() const;
    std::uint64_t bytesLeft() const { return static_cast<std::uint64_t>(end_ - at_); }
    std::uint64_t offset() const { return static_cast<std::uint64_t>(at_ - begin_); }

    std::string_view nextWord() const;
    /// Line of the first value at or after `offset`, counted from 1 at the start of the body.
    std::uint64_t line(std::uint64_t offset) const;

private:
    void skipBlanks() {
        while (at_ != end_ && isBlank(*at_)) ++at_;
    }
    bool endsHere(const char* at) const { return at == end_ || isBlank(*at); }
    static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
    bool slowNumber(std::int64_t decimalExponent, double& value);

    const char* begin_;
    const char* at_;
    const char* end_;
};

}  // namespace eyrie::import
