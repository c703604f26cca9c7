// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/jitter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace eyrie::compound {
namespace {

TEST(Jitter, HasEverySampleInAColumnAndARowOfItsOwn) {
    for (const std::int64_t count : {1, 2, 3, 4, 5, 7, 8, 16, 24, 66, 256}) {
        std::vector<bool> columns(static_cast<std::size_t>(count), false);
        std::vector<bool> rows = columns;
        for (std::int64_t i = 0; i < count; ++i) {
            const fabric::Vec2 place = (jitter(i, count) + .5) * static_cast<double>(count) - .5;
            EXPECT_NEAR(place.x, std::round(place.x), 1e-9);
            EXPECT_NEAR(place.y, std::round(place.y), 1e-9);
            columns.at(static_cast<std::size_t>(std::lround(place.x))) = true;
            rows.at(static_cast<std::size_t>(std::lround(place.y))) = true;
        }
        EXPECT_EQ(std::count(columns.begin(), columns.end(), false), 0) << count;
        EXPECT_EQ(std::count(rows.begin(), rows.end(), false), 0) << count;
    }
}

}  // namespace
}  // namespace eyrie::compound
