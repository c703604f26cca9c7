// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/weld.h"

#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::import {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Few different values, so that many keys are equal.
rc::Gen<std::vector<VertexKey>> keys() {
    const auto make = [](std::uint64_t position, std::uint32_t normal, std::uint32_t colour) {
        return VertexKey{position << 40, normal << 20, colour};
    };
    return rc::gen::container<std::vector<VertexKey>>(
        30, rc::gen::apply(make, rc::gen::inRange<std::uint64_t>(0, 6),
                           rc::gen::inRange<std::uint32_t>(0, 2),
                           rc::gen::inRange<std::uint32_t>(0, 2)));
}

RC_GTEST_PROP(Weld, MakesOneVertexOfEqualUsedKeysAndOfNoOthers, ()) {
    const std::vector<VertexKey> all = *keys();
    const auto triangles = *rc::gen::container<Triangles>(
        rc::gen::container<std::array<std::uint32_t, 3>>(rc::gen::inRange<std::uint32_t>(0, 30)));
    const Weld welded = weld(all, triangles);
    std::set<std::uint32_t> used;
    for (const auto& triangle : triangles) used.insert(triangle.begin(), triangle.end());
    std::set<std::tuple<std::uint64_t, std::uint32_t, std::uint32_t>> different;
    for (std::uint32_t a = 0; a < all.size(); ++a) {
        RC_ASSERT((welded.vertexOf[a] == kNoVertex) == !used.contains(a));
        if (!used.contains(a))
            continue;
        different.insert({all[a].position, all[a].normal, all[a].colour});
        RC_ASSERT(all[welded.firstKey[welded.vertexOf[a]]] == all[a]);
        for (const std::uint32_t b : used)
            RC_ASSERT((welded.vertexOf[a] == welded.vertexOf[b]) == (all[a] == all[b]));
    }
    RC_ASSERT(welded.vertexCount() == different.size());
}

TEST(Weld, NumbersVerticesInTheOrderOfFirstUse) {
    const std::vector<VertexKey> all = {{5, 0, 0}, {9, 0, 0}, {5, 0, 0}, {7, 0, 0}, {1, 0, 0}};
    const Weld welded = weld(all, Triangles{{3, 2, 1}, {0, 1, 3}});
    EXPECT_EQ(welded.vertexOf, (std::vector<std::uint32_t>{1, 2, 1, 0, kNoVertex}));
    EXPECT_EQ(welded.firstKey, (std::vector<std::uint32_t>{3, 2, 1}));
}

TEST(Weld, OfNothingIsEmpty) { EXPECT_EQ(weld({}, Triangles{}).vertexCount(), 0U); }

}  // namespace
}  // namespace eyrie::import
