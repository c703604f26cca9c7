// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/origin.h"

#include <gtest/gtest.h>

namespace eyrie::http {
namespace {

TEST(Origin, MustBeTheVeryHostAndOnLoopbackNoStrangersName) {
    EXPECT_TRUE(isAllowedOrigin("", "127.0.0.1:8080", true));
    EXPECT_TRUE(isAllowedOrigin("http://localhost:8080", "LOCALHOST:8080", true));
    EXPECT_TRUE(isAllowedOrigin("http://[::1]:8080", "[::1]:8080", true));
    EXPECT_TRUE(isAllowedOrigin("https://eyrie.example", "eyrie.example", false));
    EXPECT_FALSE(isAllowedOrigin("http://evil.example:8080", "evil.example:8080", true));
    EXPECT_FALSE(isAllowedOrigin("", "evil.example:8080", true));
    EXPECT_FALSE(isAllowedOrigin("http://evil.example", "eyrie.example", false));
    EXPECT_FALSE(isAllowedOrigin("http://", "", false));
    EXPECT_FALSE(isAllowedOrigin("ftp://eyrie.example", "eyrie.example", false));
    EXPECT_FALSE(isAllowedOrigin("http://127.0.0.1", "[", true));
}

}  // namespace
}  // namespace eyrie::http
