// SPDX-License-Identifier: Apache-2.0
#include "fabric/json_text.h"

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

}  // namespace
}  // namespace eyrie::fabric
