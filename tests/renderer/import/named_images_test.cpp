// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/named_images.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/mesh/material.h"

namespace eyrie::import {
namespace {

TEST(ImagesNamedIn, AreThoseOfTextAndOfBytes) {
    EXPECT_THAT(imagesNamedIn("map 'a b.PNG' <c.jpeg> c.jpeg\x01 d.e.tga\x02.txt g.pngs"),
                testing::ElementsAre("a b.PNG", "c.jpeg", "d.e.tga"));
    EXPECT_THAT(imagesNamedIn(""), testing::IsEmpty());
}

/// However often a file names one, or how many: a hundred times its size would be kept else.
TEST(ImagesNamedIn, AreAsManyAsAModelMayShow) {
    std::string same, others;
    for (std::uint32_t i = 0; i < 3 * mesh::kMaxMaterials; ++i) {
        same += "a.png;";
        others += fmt::format("{}.png;", i);
    }
    EXPECT_THAT(imagesNamedIn(same), testing::ElementsAre("a.png"));
    const std::size_t kept = imagesNamedIn(others).size();
    EXPECT_GE(kept, mesh::kMaxMaterials);
    EXPECT_LE(kept, 2 * mesh::kMaxMaterials);
}

}  // namespace
}  // namespace eyrie::import
