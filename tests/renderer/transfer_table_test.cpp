// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/transfer_table.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::draw {
namespace {

using fabric::HeightUnit;
using fabric::PrimitiveShape;

constexpr double kLowest = -120;
constexpr double kRelief = 3400;

double share() { return *rc::gen::inRange(0, 1001) / 1000.0; }

fabric::TransferFunction anyFunction(HeightUnit unit, const std::vector<PrimitiveShape>& shapes) {
    fabric::TransferFunction function;
    function.unit = unit;
    const int count = *rc::gen::inRange(1, 7);
    for (int i = 0; i < count; ++i)
        function.primitives.push_back({*rc::gen::elementOf(shapes),
                                       share(),
                                       0.05 + share(),
                                       {share(), share(), share()},
                                       0.1 + 0.9 * share()});
    if (unit == HeightUnit::Metres)
        for (fabric::TransferPrimitive& primitive : function.primitives) {
            primitive.centre = kLowest + primitive.centre * kRelief;
            primitive.width *= kRelief;
        }
    return function;
}

/// What the table answers at a share of the relief, filtered between texels.
fabric::Vec4 lookedUp(const std::vector<std::uint8_t>& table, double at) {
    const double texel = at * (kTransferTexels - 1);
    const int low = std::min(static_cast<int>(texel), kTransferTexels - 2);
    const auto byte = [&](int index) -> double { return table[static_cast<std::size_t>(index)]; };
    fabric::Vec4 result;
    for (int i = 0; i < 4; ++i)
        result[i] = glm::mix(byte(4 * low + i), byte(4 * low + 4 + i), texel - low) / 255;
    return result;
}

RC_GTEST_PROP(TransferTable, IsTheFunctionLessRoundingWhereverThatIsSmooth, ()) {
    const HeightUnit unit = *rc::gen::element(HeightUnit::Relative, HeightUnit::Metres);
    // One primitive alone has one colour, so all that varies is opacity, by at most 40 a relief.
    fabric::TransferFunction function =
        anyFunction(unit, {PrimitiveShape::Blend, PrimitiveShape::Tent, PrimitiveShape::Smooth});
    function.primitives.resize(1);
    const auto table = transferTable(function, kLowest, kRelief);
    RC_ASSERT(table.size() == std::size_t{4} * kTransferTexels);
    const double at = share();
    const fabric::Tint tint =
        evaluate(function, unit == HeightUnit::Relative ? at : kLowest + at * kRelief);
    const fabric::Vec4 found = lookedUp(table, at);
    constexpr double kSteepest = 4 / 0.05;  // a blend's, at half its width
    RC_ASSERT(std::abs(found.a - tint.opacity) <= 0.5 / 255 + kSteepest / kTransferTexels);
    for (int i = 0; i < 3; ++i)
        if (tint.opacity > 0)
            RC_ASSERT(std::abs(found[i] - std::sqrt(tint.colour[i])) <= 0.5 / 255 + 1e-9);
}

RC_GTEST_PROP(TransferTable, HoldsTheFunctionAtEveryTexel, ()) {
    const fabric::TransferFunction function = anyFunction(
        HeightUnit::Relative,
        {PrimitiveShape::Blend, PrimitiveShape::Box, PrimitiveShape::Tent, PrimitiveShape::Smooth});
    const auto table = transferTable(function, kLowest, kRelief);
    for (int i = 0; i < kTransferTexels; ++i) {
        const double at = static_cast<double>(i) / (kTransferTexels - 1);
        const fabric::Tint tint = evaluate(function, at);
        const fabric::Vec4 found = lookedUp(table, at);
        RC_ASSERT(std::abs(found.a - tint.opacity) <= 0.5 / 255 + 1e-6);
        for (int channel = 0; channel < 3 && tint.opacity > 0; ++channel)
            RC_ASSERT(std::abs(found[channel] - std::sqrt(tint.colour[channel])) <=
                      0.5 / 255 + 1e-6);
    }
}

RC_GTEST_PROP(TransferTable, LosesNoPrimitiveHoweverNarrow, ()) {
    const HeightUnit unit = *rc::gen::element(HeightUnit::Relative, HeightUnit::Metres);
    fabric::TransferFunction function = anyFunction(
        unit,
        {PrimitiveShape::Blend, PrimitiveShape::Box, PrimitiveShape::Tent, PrimitiveShape::Smooth});
    function.primitives.resize(1);
    fabric::TransferPrimitive& mark = function.primitives[0];
    mark.width = 1e-4 * (unit == HeightUnit::Relative ? 1 : kRelief);
    const auto table = transferTable(function, kLowest, kRelief);
    const double at =
        unit == HeightUnit::Relative ? mark.centre : (mark.centre - kLowest) / kRelief;
    const double most = mark.shape == PrimitiveShape::Box ? 1 : 0.5;  // midway between two texels
    RC_ASSERT(lookedUp(table, at).a >= most * mark.opacity - 0.5 / 255 - 1e-6);
}

TEST(TransferTable, DoesNotDarkenWhatFadesOut) {
    const fabric::TransferFunction white{HeightUnit::Relative,
                                         {{PrimitiveShape::Tent, 0.5, 0.1, {1, 1, 1}, 1}}};
    const auto table = transferTable(white, 0, 1);
    for (std::size_t i = 0; i < table.size(); i += 4) EXPECT_EQ(table[i], 255) << i;
    EXPECT_EQ(table[3], 0);
    EXPECT_EQ(transferTable({}, 0, 1)[3], 0) << "no primitive is bare ground";
}

}  // namespace
}  // namespace eyrie::draw
