// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_values.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::import {
namespace {

/// The bits of what is read from `text`, or of NaN where nothing is.
std::uint64_t bitsOf(const std::string& text, PlyType type = PlyType::Float64) {
    double value = 0;
    AsciiValues values(text);
    return std::bit_cast<std::uint64_t>(values.number(type, value) ? value : std::nan(""));
}

std::uint64_t bitsOf(double value) { return std::bit_cast<std::uint64_t>(value); }

RC_GTEST_PROP(AsciiValues, ReadsWhatThePrinterOfTheLibraryWrote, ()) {
    const auto value = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
    RC_PRE(std::isfinite(value));
    const int digits = *rc::gen::inRange(1, 25);
    std::array<char, 64> text;
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    RC_ASSERT(bitsOf(text.data()) == bitsOf(std::strtod(text.data(), nullptr)));
}

RC_GTEST_PROP(AsciiValues, ReadsFixedPointAsTheLibraryDoes, ()) {
    const double value = *rc::gen::inRange(-100000000, 100000000) / 1e5;
    std::array<char, 64> text;
    std::snprintf(text.data(), text.size(), "%.*f", *rc::gen::inRange(0, 18), value);
    RC_ASSERT(bitsOf(text.data()) == bitsOf(std::strtod(text.data(), nullptr)));
}

TEST(AsciiValues, ReadsEveryWayToWriteANumber) {
    for (const std::string text : {"0",
                                   "-0",
                                   "-0.0",
                                   "+1.5",
                                   "1.",
                                   ".5",
                                   "-.25",
                                   "1e3",
                                   "1E+3",
                                   "1e-3",
                                   "12345678901234567890",
                                   "0.00000000000000000000000000001",
                                   "9007199254740993",
                                   "1e22",
                                   "1e23",
                                   "1e-23",
                                   "1e400",
                                   "-1e400",
                                   "1e-400",
                                   "4.9406564584124654e-324",
                                   "1.7976931348623157e308",
                                   "inf",
                                   "-inf",
                                   "123456789012345678901234567890123456789012345678901234567890"})
        EXPECT_EQ(bitsOf(text), bitsOf(std::strtod(text.c_str(), nullptr))) << text;
    double value = 0;
    EXPECT_TRUE(AsciiValues("nan").number(PlyType::Float64, value));
    EXPECT_TRUE(std::isnan(value));
}

TEST(AsciiValues, RoundsToTheTypeThatTheHeaderDeclares) {
    EXPECT_EQ(bitsOf("0.1", PlyType::Float32), bitsOf(static_cast<double>(0.1F)));
    EXPECT_EQ(bitsOf("0.1", PlyType::Float64), bitsOf(0.1));
}

TEST(AsciiValues, RefusesWhatIsNoNumberAndStaysThere) {
    for (const std::string text :
         {"", " \n", "x", "1x", "1.5.2", "--1", "1e", "e5", ".", "-", "1,5", "0x10", "1.#IND"}) {
        double value = 7;
        AsciiValues values(text);
        EXPECT_FALSE(values.number(PlyType::Float64, value)) << text;
        EXPECT_EQ(values.atEnd(), text.empty() || text == " \n") << text;
    }
    for (const std::string text : {"", "1.0", "99999999999999999999", "0x1", "-", "a"}) {
        std::int64_t value = 7;
        EXPECT_FALSE(AsciiValues(text).integer(PlyType::Int32, value)) << text;
    }
}

TEST(AsciiValues, TellLineAndWordOfTheNextValue) {
    AsciiValues values("1 2\r\n\r\n 3 four\n");
    ASSERT_TRUE(values.skip(PlyType::Int8, 3));
    EXPECT_EQ(values.line(0), 1U);
    EXPECT_EQ(values.line(values.offset()), 3U);
    EXPECT_EQ(values.nextWord(), "four");
    EXPECT_FALSE(values.skip(PlyType::Int8, 2));
    EXPECT_TRUE(values.atEnd());
}

TEST(BinaryValues, ReadEveryTypeInBothByteOrders) {
    const std::string little("\xFE\x01\x80\xFF\xFF\xFF\xFF\x00\x00\xC0\xBF", 11);
    std::int64_t whole = 0;
    double number = 0;
    BinaryValues<false> values(little);
    EXPECT_TRUE(values.integer(PlyType::Int8, whole) && whole == -2);
    EXPECT_TRUE(values.integer(PlyType::UInt16, whole) && whole == 0x8001);
    EXPECT_TRUE(values.integer(PlyType::UInt32, whole) && whole == 0xFFFFFFFF);
    EXPECT_TRUE(values.number(PlyType::Float32, number) && number == -1.5);
    EXPECT_FALSE(values.integer(PlyType::UInt8, whole));

    const std::string big("\x80\x01\xFF\xFF\xFF\xFE\x3F\xF8\x00\x00\x00\x00\x00\x00", 14);
    BinaryValues<true> swapped(big);
    EXPECT_TRUE(swapped.integer(PlyType::Int16, whole) && whole == -32767);
    EXPECT_TRUE(swapped.integer(PlyType::Int32, whole) && whole == -2);
    EXPECT_TRUE(swapped.number(PlyType::Float64, number) && number == 1.5);
}

TEST(BinaryValues, NeverSkipPastTheEnd) {
    BinaryValues<false> values("12345678");
    EXPECT_FALSE(values.skip(PlyType::Float64, std::numeric_limits<std::uint64_t>::max() / 8 + 2));
    EXPECT_FALSE(values.skip(PlyType::Int16, 5));
    EXPECT_TRUE(values.skip(PlyType::Int16, 4));
    EXPECT_EQ(values.bytesLeft(), 0U);
}

}  // namespace
}  // namespace eyrie::import
