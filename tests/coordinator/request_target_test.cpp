// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/request_target.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::http {
namespace {

using Found = std::optional<AbsoluteTarget>;

TEST(RequestTarget, InAbsoluteFormHasAHostAndTheRest) {
    const auto found = [](std::string_view target) {
        return absoluteTarget(target, false).value();
    };
    EXPECT_EQ(found("http://viz:8080/api?x=1"), (AbsoluteTarget{"viz:8080", "/api?x=1"}));
    EXPECT_EQ(found("HTTP://[::1]:80/"), (AbsoluteTarget{"[::1]:80", "/"}));
    EXPECT_EQ(found("http://viz"), (AbsoluteTarget{"viz", "/"}));
    EXPECT_EQ(found("http://viz:?a/b"), (AbsoluteTarget{"viz:", "/?a/b"}));
    EXPECT_EQ(found("http://viz//etc/passwd"), (AbsoluteTarget{"viz", "//etc/passwd"}));
    EXPECT_EQ(found("http://viz/http://evil/"), (AbsoluteTarget{"viz", "/http://evil/"}));
    for (const char* other : {"", "/", "/api?x=http://a/", "*", "viz:8080", "//viz/", "http:/viz/",
                              "://viz/", "1http://viz/", " http://viz/"})
        EXPECT_EQ(found(other), Found()) << other;
}

TEST(RequestTarget, OfAnotherSchemeIsForAnotherServer) {
    EXPECT_TRUE(absoluteTarget("https://viz/", true).ok());
    EXPECT_TRUE(absl::IsFailedPrecondition(absoluteTarget("http://viz/", true).status()));
    EXPECT_TRUE(absl::IsFailedPrecondition(absoluteTarget("https://viz/", false).status()));
    EXPECT_TRUE(absl::IsFailedPrecondition(absoluteTarget("file:///etc/passwd", false).status()));
}

TEST(RequestTarget, NamesAHostAndNoUserAndNothingThatOthersReadAsAnother) {
    for (const char* target :
         {"http://", "http:///etc/passwd", "http://:80/", "http://user@viz/", "http://viz:80@evil/",
          "http://viz:x/", "http://viz:80:80/", "http://[::1/", "http://[]/", "http://[::1]evil/",
          "http://[::1].evil/", "http://[viz@evil]/", "http://v%69z/", "http://viz\\evil/",
          "http://viz#evil/", "http://viz;evil/", "http://viz,evil/", "http://\xc3\xb6/"})
        EXPECT_TRUE(absl::IsInvalidArgument(absoluteTarget(target, false).status())) << target;
}

RC_GTEST_PROP(RequestTarget, IsTakenApartIntoWhatItWasMadeOf, (const std::string& after)) {
    const Found found = absoluteTarget("http://viz:1/" + after, false).value();
    RC_ASSERT(found == Found(AbsoluteTarget{"viz:1", "/" + after}));
}

}  // namespace
}  // namespace eyrie::http
