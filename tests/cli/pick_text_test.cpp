// SPDX-License-Identifier: Apache-2.0
#include "cli/pick_text.h"

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>

#include <gmock/gmock.h>

namespace eyrie::cli {
namespace {

/// The number that follows `words`.
double numberAfter(const std::string& text, const std::string& words) {
    const std::size_t at = text.find(words);
    EXPECT_NE(at, std::string::npos) << words << " in " << text;
    return std::strtod(text.c_str() + at + words.size(), nullptr);
}

TEST(PickText, RangesHoldAsTheyAreRead) {
    for (int i = 0; i < 1000; ++i) {
        fabric::PickedPoint point;
        point.distanceMetres = 1234.5678 + 0.123456789 * i;
        point.errorMetres = 1e-9;
        point.nearestMetres = point.distanceMetres - 1e-9;
        point.farthestMetres = point.distanceMetres + 1e-9;
        const std::string text = pickText(point, "dem");
        EXPECT_LE(numberAfter(text, "met from "), point.nearestMetres);
        EXPECT_GE(numberAfter(text, ", by "), point.farthestMetres);
        EXPECT_EQ(numberAfter(text, "distance "), point.distanceMetres);
    }
}

TEST(PickText, ElevationsAreOffByNoMoreThanIsSaidBesideThem) {
    for (const double error : {0.0, 1e-12, 0.00777, 0.2, 30.0, 500.0}) {
        fabric::PickedPoint point;
        point.elevationMetres = 1234.56789012345;
        point.elevationErrorMetres = error;
        const std::string text = pickText(point, "dem");
        const double lost = std::abs(numberAfter(text, "elevation ") - *point.elevationMetres);
        EXPECT_GE(numberAfter(text, " m, off by "), error + lost) << text;
        EXPECT_LT(lost, error / 10 + 1e-6) << text;
    }
}

TEST(PickText, SaysWhereTheSourceMayBeMissed) {
    fabric::PickedPoint point;
    point.farthestMetres = std::numeric_limits<double>::infinity();
    EXPECT_THAT(pickText(point, "dem"), testing::HasSubstr(", if at all\n"));
    EXPECT_THAT(pickText(point, "dem"), testing::Not(testing::HasSubstr("elevation")));
}

}  // namespace
}  // namespace eyrie::cli
