// SPDX-License-Identifier: Apache-2.0
// Decimal to binary: W. D. Clinger, "How to Read Floating Point Numbers Accurately", 1990: up to
// 2^53 times or by up to 10^22 is one correctly rounded operation. The rest goes to from_chars.
#include "renderer/import/ply_values.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace eyrie::import {
namespace {

constexpr std::array<double, 23> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::uint64_t kExactIntegers = std::uint64_t{1} << 53;
constexpr int kDigitsOf64Bits = 19;

bool isDigit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

/// Digits, a point among them perhaps, as mantissa * 10^exponent.
struct Decimal {
    std::uint64_t mantissa = 0;
    std::int64_t exponent = 0;
    std::ptrdiff_t digits = 0;
};

const char* scanDigits(const char* at, const char* end, Decimal& decimal) {
    const char* start = at;
    for (; at != end && isDigit(*at); ++at)
        decimal.mantissa = decimal.mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
    decimal.digits += at - start;
    return at;
}

const char* scanExponent(const char* at, const char* end, Decimal& decimal) {
    const char* digit = at + 1;
    const bool negative = digit != end && *digit == '-';
    if (digit != end && (*digit == '-' || *digit == '+'))
        ++digit;
    if (digit == end || !isDigit(*digit))
        return at;
    std::int64_t exponent = 0;
    for (; digit != end && isDigit(*digit); ++digit)
        exponent = std::min<std::int64_t>(exponent * 10 + (*digit - '0'), 1'000'000);
    decimal.exponent += negative ? -exponent : exponent;
    return digit;
}

const char* scanDecimal(const char* at, const char* end, Decimal& decimal) {
    at = scanDigits(at, end, decimal);
    if (at != end && *at == '.') {
        const char* fraction = at + 1;
        at = scanDigits(fraction, end, decimal);
        decimal.exponent -= at - fraction;
    }
    if (decimal.digits > 0 && at != end && (*at == 'e' || *at == 'E'))
        at = scanExponent(at, end, decimal);
    return at;
}

}  // namespace

bool AsciiValues::number(PlyType type, double& value) {
    skipBlanks();
    const bool negative = at_ != end_ && *at_ == '-';
    Decimal decimal;
    const char* after = scanDecimal(negative ? at_ + 1 : at_, end_, decimal);
    if (endsHere(after) && decimal.digits > 0 && decimal.digits <= kDigitsOf64Bits &&
        decimal.mantissa <= kExactIntegers && decimal.exponent >= -22 && decimal.exponent <= 22) {
        const auto mantissa = static_cast<double>(decimal.mantissa);
        const double magnitude =
            decimal.exponent < 0
                ? mantissa / kPowersOfTen[static_cast<std::size_t>(-decimal.exponent)]
                : mantissa * kPowersOfTen[static_cast<std::size_t>(decimal.exponent)];
        value = negative ? -magnitude : magnitude;
        at_ = after;
    } else if (!slowNumber(decimal.exponent + decimal.digits, value)) {
        return false;
    }
    if (type == PlyType::Float32)
        value = static_cast<double>(static_cast<float>(value));
    return true;
}

bool AsciiValues::slowNumber(std::int64_t decimalExponent, double& value) {
    const char* start = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto parsed = std::from_chars(start, end_, value);
    if (parsed.ec == std::errc::invalid_argument || !endsHere(parsed.ptr))
        return false;
    if (parsed.ec == std::errc::result_out_of_range) {
        value = decimalExponent < 0 ? 0.0 : std::numeric_limits<double>::infinity();
        value = *start == '-' ? -value : value;
    }
    at_ = parsed.ptr;
    return true;
}

bool AsciiValues::integer(PlyType, std::int64_t& value) {
    skipBlanks();
    const char* at = at_;
    const bool negative = at != end_ && *at == '-';
    if (at != end_ && (*at == '-' || *at == '+'))
        ++at;
    Decimal decimal;
    at = scanDigits(at, end_, decimal);
    if (decimal.digits == 0 || decimal.digits >= kDigitsOf64Bits || !endsHere(at))
        return false;
    value = static_cast<std::int64_t>(decimal.mantissa);
    value = negative ? -value : value;
    at_ = at;
    return true;
}

bool AsciiValues::skip(PlyType, std::uint64_t count) {
    for (; count != 0; --count) {
        skipBlanks();
        if (at_ == end_)
            return false;
        while (!endsHere(at_)) ++at_;
    }
    return true;
}

bool AsciiValues::atEnd() const { return std::all_of(at_, end_, isBlank); }

std::string_view AsciiValues::nextWord() const {
    const char* start = std::find_if_not(at_, end_, isBlank);
    const char* end = std::find_if(start, end_, isBlank);
    return {start, static_cast<std::size_t>(end - start)};
}

std::uint64_t AsciiValues::line(std::uint64_t offset) const {
    const char* start = std::find_if_not(begin_ + offset, end_, isBlank);
    return static_cast<std::uint64_t>(std::count(begin_, start, '\n')) + 1;
}

}  // namespace eyrie::import
