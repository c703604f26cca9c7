// SPDX-License-Identifier: Apache-2.0
#include "cli/options/one_of.h"

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::cli {
namespace {

enum class Speed { Slow = 3, Fast = 7 };

class Choices : public testing::Test {
protected:
    Choices() {
        app_.add_option("--level", level_)->check(oneOf({"debug", "info", "warn"}));
        app_.add_option("--speed", speed_)
            ->transform(valueOf(
                std::map<std::string, Speed>{{"fast", Speed::Fast}, {"slow", Speed::Slow}}));
    }

    /// Nothing where the line is taken.
    std::string errorOf(const std::string& option, const std::string& word) {
        try {
            app_.parse({word, option});
        } catch (const CLI::ParseError& error) {
            return error.what();
        }
        return "";
    }

    CLI::App app_{"test", "eyrie"};
    std::string level_;
    Speed speed_ = Speed::Slow;
};

TEST_F(Choices, AreTakenByTheirNames) {
    EXPECT_EQ(errorOf("--level", "info"), "");
    EXPECT_EQ(level_, "info");
    EXPECT_EQ(errorOf("--speed", "fast"), "");
    EXPECT_EQ(speed_, Speed::Fast);
}

TEST_F(Choices, AreAllNamedWhereAWordIsNoneOfThem) {
    EXPECT_EQ(errorOf("--level", "nonsense"), "--level: 'nonsense' is none of debug, info, warn");
    EXPECT_EQ(errorOf("--speed", "fas"),
              "--speed: 'fas' is none of fast, slow, did you mean 'fast'?");
}

TEST_F(Choices, AreNotTakenByNumberOrInOtherCase) {
    for (const char* word : {"7", "", "Fast", "fast "})
        EXPECT_THAT(errorOf("--speed", word), testing::HasSubstr("is none of fast, slow")) << word;
    EXPECT_EQ(speed_, Speed::Slow);
}

}  // namespace
}  // namespace eyrie::cli
