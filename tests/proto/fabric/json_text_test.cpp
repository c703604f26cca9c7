// SPDX-License-Identifier: Apache-2.0
#include "fabric/json_text.h"

#include <limits>
#include <string_view>

#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

TEST(QuotedJson, IsUtf8WhateverItQuotes) {
    EXPECT_EQ(quotedJson("a\"b\\c\x1b[2J"), R"("a\"b\\c\u001b[2J")");
    EXPECT_EQ(quotedJson("D\xc3\xa4"
                         "cher \xf0\x9f\x8f\xa0"),
              "\"D\xc3\xa4"
              "cher \xf0\x9f\x8f\xa0\"");
    EXPECT_EQ(quotedJson("D\xe4"
                         "cher"),
              "\"D?cher\"");
    EXPECT_EQ(quotedJson("\xc3"), "\"?\"");
    EXPECT_EQ(quotedJson("\xed\xa0\x80"), "\"???\"") << "half of a pair";
    EXPECT_EQ(quotedJson("\xc0\xaf"), "\"??\"") << "too long";
}

TEST(NumberJson, IsTheShortestThatReadsBackOrAString) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(numberJson(0.1), "0.1");
    EXPECT_EQ(numberJson(std::numeric_limits<double>::max()), "1.7976931348623157e+308");
    EXPECT_EQ(numberJson(kInfinity), "\"Infinity\"");
    EXPECT_EQ(numberJson(-kInfinity), "\"-Infinity\"");
    EXPECT_EQ(numberJson(std::numeric_limits<double>::quiet_NaN()), "null");
}

TEST(JoinNumbers, PutsListsOfNumbersOnOneLineAndLeavesTheRest) {
    const auto joined = [](std::string json) {
        joinNumbers(json);
        return json;
    };
    EXPECT_EQ(joined("{\n \"eye\": [\n  1,\n  -2.5e-07,\n  3\n ],\n \"up\": []\n}\n"),
              "{\n \"eye\": [1, -2.5e-07, 3],\n \"up\": []\n}\n");
    for (const char* same :
         {"", "[", "[\n 1,\n", "\"", "\"\\", "{\n \"a\": [\n  \"1\",\n  \"2\"\n ]\n}\n",
          "{\n \"[\\\"\": \"[\\n 1,\\n [ 2 ]\"\n}\n"})
        EXPECT_EQ(joined(same), same);
    EXPECT_EQ(joined("[\n [\n  1,\n  2\n ],\n [\n  3\n ]\n]\n"), "[\n [1, 2],\n [3]\n]\n");
}

}  // namespace
}  // namespace eyrie::fabric
