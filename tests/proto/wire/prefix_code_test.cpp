// SPDX-License-Identifier: Apache-2.0
#include "wire/prefix_code.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::wire {
namespace {

/// What share of all sequences of bits begin with one of the codes: 1 where none is left over.
double filled(const std::vector<std::uint8_t>& lengths) {
    double sum = 0;
    for (const int length : lengths)
        if (length > 0)
            sum += std::ldexp(1.0, -length);
    return sum;
}

std::vector<std::uint32_t> fibonacci(std::size_t count) {
    std::vector<std::uint32_t> numbers{1, 1};
    while (numbers.size() < count) numbers.push_back(numbers.end()[-1] + numbers.end()[-2]);
    return numbers;
}

RC_GTEST_PROP(PrefixCode, LeavesNoBitsUnusedAndTakesLessThanOneBitMoreThanEntropy, ()) {
    const auto counts = *rc::gen::container<std::vector<std::uint32_t>>(
        286, rc::gen::inRange<std::uint32_t>(0, 5000));
    RC_PRE(std::count_if(counts.begin(), counts.end(), [](auto n) { return n > 0; }) > 1);
    const auto lengths = codeLengths(counts, 15);
    RC_ASSERT(filled(lengths) == 1.0);
    double all = 0, bits = 0, entropy = 0;
    for (const std::uint32_t count : counts) all += count;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        RC_ASSERT((lengths[i] > 0) == (counts[i] > 0));
        if (counts[i] > 0)
            entropy += counts[i] * std::log2(all / counts[i]);
        bits += static_cast<double>(lengths[i]) * counts[i];
    }
    RC_ASSERT(bits >= entropy * (1 - 1e-12));
    RC_ASSERT(bits < entropy + all);
}

/// By the definition: the two that occur least become one, again and again, and each of these takes
/// a bit of all that are in it.
std::uint64_t fewestBits(const std::vector<std::uint32_t>& counts) {
    std::multiset<std::uint64_t> left;
    for (const std::uint32_t count : counts)
        if (count > 0)
            left.insert(count);
    std::uint64_t bits = 0;
    while (left.size() > 1) {
        const std::uint64_t both = *left.begin() + *std::next(left.begin());
        left.erase(left.begin(), std::next(left.begin(), 2));
        left.insert(both);
        bits += both;
    }
    return bits;
}

RC_GTEST_PROP(PrefixCode, TakesTheFewestBitsThatACodeCan, ()) {
    const int magnitude = *rc::gen::inRange(1, 25);
    const auto counts = *rc::gen::container<std::vector<std::uint32_t>>(
        286, rc::gen::inRange<std::uint32_t>(0, 1u << magnitude));
    RC_PRE(std::count_if(counts.begin(), counts.end(), [](auto n) { return n > 0; }) > 1);
    const auto lengths = codeLengths(counts, 60);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) bits += std::uint64_t{lengths[i]} * counts[i];
    RC_ASSERT(bits == fewestBits(counts));
}

TEST(PrefixCode, IsNoLongerThanAskedWhereCountsWouldHaveIt) {
    for (const int longest : {5, 7, 15}) {
        const auto lengths = codeLengths(fibonacci(longest == 15 ? 40 : 19), longest);
        EXPECT_EQ(*std::max_element(lengths.begin(), lengths.end()), longest);
        EXPECT_EQ(filled(lengths), 1.0);
        EXPECT_TRUE(std::is_sorted(lengths.rbegin(), lengths.rend()))
            << "rare ones are not shorter";
    }
}

TEST(PrefixCode, TakesOneBitForTheOnlySymbol) {
    EXPECT_EQ(codeLengths(std::vector<std::uint32_t>{0, 7, 0}, 15),
              (std::vector<std::uint8_t>{0, 1, 0}));
    EXPECT_EQ(codeLengths(std::vector<std::uint32_t>{0, 0}, 15), (std::vector<std::uint8_t>{0, 0}));
}

/// The example of RFC 1951, 3.2.2: A to H are 010, 011, 100, 101, 110, 00, 1110 and 1111.
TEST(PrefixCode, HasTheCodesOfDeflatesDefinition) {
    const std::vector<std::uint8_t> lengths{3, 3, 3, 3, 3, 2, 4, 4};
    EXPECT_EQ(codesOf(lengths), (std::vector<std::uint16_t>{0b010, 0b110, 0b001, 0b101, 0b011, 0b00,
                                                            0b0111, 0b1111}));
}

}  // namespace
}  // namespace eyrie::wire
