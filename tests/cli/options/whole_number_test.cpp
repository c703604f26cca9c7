// SPDX-License-Identifier: Apache-2.0
#include "cli/options/whole_number.h"

#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace eyrie::cli {
namespace {

class WholeNumber : public testing::Test {
protected:
    WholeNumber() { app_.add_option("--count", count_)->transform(wholeNumber()); }

    bool takes(const std::string& word) {
        try {
            app_.parse("--count=" + word);
        } catch (const CLI::ParseError&) {
            return false;
        }
        return true;
    }

    CLI::App app_{"test", "eyrie"};
    std::uint64_t count_ = 7;
};

TEST_F(WholeNumber, IsTakenAsItIsWritten) {
    EXPECT_TRUE(takes("0"));
    EXPECT_EQ(count_, 0U);
    EXPECT_TRUE(takes("010"));
    EXPECT_EQ(count_, 10U);
    EXPECT_TRUE(takes("18446744073709551615"));
    EXPECT_EQ(count_, std::numeric_limits<std::uint64_t>::max());
}

TEST_F(WholeNumber, IsNeitherNegativeNorCutToWhatFits) {
    for (const char* word : {"-1", "+1", "18446744073709551616", "1.5", "1e3", "0x10", "many"})
        EXPECT_FALSE(takes(word)) << word;
    EXPECT_EQ(count_, 7U);
}

}  // namespace
}  // namespace eyrie::cli
