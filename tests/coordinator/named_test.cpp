// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/named.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::config {
namespace {

struct Named {
    std::string name;
};

TEST(Named, ThingsAreFoundByTheirNamesOrElseTheirPositions) {
    const std::vector<Named> things{{"1"}, {""}, {"1"}, {"left"}};
    EXPECT_EQ(*findNamed(things, "thing", "1"), 0U) << "a name comes before a position";
    EXPECT_EQ(*findNamed(things, "thing", "#1"), 1U);
    EXPECT_EQ(*findNamed(things, "thing", "left"), 3U);
    EXPECT_EQ(*findNamed(things, "thing", "2"), 2U);
    for (const char* none :
         {"", "#", "#4", "4", "#01", "01", "+1", " 1", "1 ", "-0", "18446744073709551617"})
        EXPECT_FALSE(findNamed(things, "thing", none).ok()) << none;
    EXPECT_EQ(called(things, 0), "1");
    EXPECT_EQ(called(things, 1), "#1") << "as \"1\" is another's name";
    EXPECT_EQ(called(things, 2), "2") << "as another is the first of that name";
    EXPECT_EQ(called(things, 3), "left");
}

/// Whatever things are called.
RC_GTEST_PROP(Named, WhatAThingIsCalledLeadsToIt, ()) {
    const auto name = rc::gen::element<std::string>("", "0", "1", "2", "#0", "#1", "a");
    std::vector<Named> things;
    for (const std::string& each : *rc::gen::container<std::vector<std::string>>(4, name))
        things.push_back({each});
    for (std::size_t i = 0; i < things.size(); ++i)
        RC_ASSERT(*findNamed(things, "thing", called(things, i)) == i);
    const std::vector<std::string> all = allCalled(things);
    for (std::size_t i = 0; i < things.size(); ++i) RC_ASSERT(all[i] == called(things, i));
}

}  // namespace
}  // namespace eyrie::config
