// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/texel_filter.h"

#include <cmath>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::terrain {
namespace {

using fabric::Rgba;

std::vector<Rgba> halved(const std::vector<Rgba>& texels, int columns, int rows) {
    std::vector<Rgba> out(static_cast<std::size_t>((columns + 1) / 2 * ((rows + 1) / 2)));
    halve(texels, columns, rows, out);
    return out;
}

/// sRGB (IEC 61966-2-1), written anew.
double linear(int byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
int encoded(double value) {
    const double c = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
    return static_cast<int>(std::lround(255 * c));
}

TEST(TexelFilter, AveragesInLinearLight) {
    const std::vector<Rgba> chequered = {
        {255, 255, 255, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}};
    EXPECT_EQ(halved(chequered, 2, 2), (std::vector<Rgba>{{188, 188, 188, 255}}));
}

RC_GTEST_PROP(TexelFilter, IsTheMeanOfFourToAByte, ()) {
    std::vector<Rgba> texels(4);
    double sum = 0;
    for (Rgba& texel : texels) {
        texel.r = *rc::gen::arbitrary<std::uint8_t>();
        sum += linear(texel.r);
    }
    RC_ASSERT(std::abs(halved(texels, 2, 2)[0].r - encoded(sum / 4)) <= 1);
}

RC_GTEST_PROP(TexelFilter, LeavesEveryEvenColourAsItIs, ()) {
    const Rgba texel{*rc::gen::arbitrary<std::uint8_t>(), *rc::gen::arbitrary<std::uint8_t>(),
                     *rc::gen::arbitrary<std::uint8_t>(), 255};
    RC_ASSERT(halved(std::vector<Rgba>(4, texel), 2, 2)[0] == texel);
}

TEST(TexelFilter, GivesHolesNoWeight) {
    const std::vector<Rgba> texels = {
        {200, 100, 50, 255}, {0, 0, 0, 0}, {200, 100, 50, 255}, {9, 9, 9, 0}};
    EXPECT_EQ(halved(texels, 2, 2), (std::vector<Rgba>{{200, 100, 50, 128}}));
    EXPECT_EQ(halved(std::vector<Rgba>(4, Rgba{5, 5, 5, 0}), 2, 2)[0].a, 0);
}

TEST(TexelFilter, RepeatsTheLastTexelOfAnOddSide) {
    const std::vector<Rgba> texels = {{10, 0, 0, 255}, {10, 0, 0, 255}, {70, 0, 0, 255},  //
                                      {10, 0, 0, 255}, {10, 0, 0, 255}, {70, 0, 0, 255},  //
                                      {30, 0, 0, 255}, {30, 0, 0, 255}, {90, 0, 0, 255}};
    const std::vector<Rgba> half = halved(texels, 3, 3);
    ASSERT_EQ(half.size(), 4U);
    EXPECT_EQ(half[0].r, 10);
    EXPECT_EQ(half[1].r, 70);
    EXPECT_EQ(half[2].r, 30);
    EXPECT_EQ(half[3].r, 90);
    EXPECT_EQ(halved({{1, 2, 3, 255}}, 1, 1), (std::vector<Rgba>{{1, 2, 3, 255}}));
}

}  // namespace
}  // namespace eyrie::terrain
