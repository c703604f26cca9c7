// SPDX-License-Identifier: Apache-2.0
#include "cli/options/options_text.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::cli {
namespace {

using testing::HasSubstr;

std::string plain(std::string_view text) { return withoutComments(text).value_or("refused"); }

TEST(OptionsText, HasNoCommentsWhereverTheyStand) {
    EXPECT_EQ(plain("# all of a line\n"
                    "log-format = \"json\"   # behind a value\n"
                    "[renderer]  # behind a section\n"
                    "memory = \"8G\"#beside it\r\n"),
              "\nlog-format = \"json\"\n[renderer]\nmemory = \"8G\"\n");
}

TEST(OptionsText, KeepsHashesInQuotes) {
    EXPECT_EQ(plain("node = \"a#b\"  # c\n"), "node = \"a#b\"\n");
    EXPECT_EQ(plain("urls = ['http://a/#1', \"b\"] # '\n"), "urls = ['http://a/#1', \"b\"]\n");
    EXPECT_EQ(plain("data = /of/bob's # \"his\"\n"), "data = /of/bob's\n");
}

TEST(OptionsText, BringsListsToOneLine) {
    EXPECT_EQ(plain("urls = [ # two\n"
                    "  \"https://a/\", # old\n"
                    "\n"
                    "  \"https://b/?x=1\"\n"
                    "]\n"
                    "token-file = \"x\"\n"),
              "urls = [\"https://a/\",\"https://b/?x=1\"]\ntoken-file = \"x\"\n");
    EXPECT_EQ(plain("urls = [\"https://a/\",\n\"https://b/\"]  # c\n[serve]\n"),
              "urls = [\"https://a/\",\"https://b/\"]\n[serve]\n");
}

TEST(OptionsText, RefusesAListWithoutItsEnd) {
    for (const char* text : {"a = 1\nurls = [\"b\",\ntoken-file = \"x\"\n",
                             "a = 1\nurls = [\"b\"\n[serve]\nc = [1]\n", "a = 1\nurls = [\n"})
        EXPECT_THAT(withoutComments(text).status().message(), HasSubstr("begins in line 2 "));
}

}  // namespace
}  // namespace eyrie::cli
