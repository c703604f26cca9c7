// SPDX-License-Identifier: Apache-2.0
#include "fabric/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace eyrie::fabric {
namespace {

constexpr PrimitiveShape kShapes[] = {PrimitiveShape::Blend, PrimitiveShape::Box,
                                      PrimitiveShape::Tent, PrimitiveShape::Smooth};

double share() { return *rc::gen::inRange(0, 1001) / 1000.0; }

TransferPrimitive anyPrimitive() {
    return {*rc::gen::elementOf(std::vector(std::begin(kShapes), std::end(kShapes))),
            share(),
            0.001 + share(),
            {share(), share(), share()},
            share()};
}

TransferFunction anyFunction() {
    TransferFunction function;
    const int count = *rc::gen::inRange(0, 9);
    for (int i = 0; i < count; ++i) function.primitives.push_back(anyPrimitive());
    return function;
}

TEST(PrimitiveShape, IsFullAtTheCentreAndEndsAtTheWidth) {
    for (const PrimitiveShape shape : kShapes) {
        EXPECT_EQ(shapeAt(shape, 0), 1);
        EXPECT_EQ(shapeAt(shape, 1), 0);
        EXPECT_EQ(shapeAt(shape, -1.5), 0);
        EXPECT_EQ(shapeAt(shape, std::numeric_limits<double>::quiet_NaN()), 0);
        for (double d = 0; d < 1; d += 0.01) {
            EXPECT_EQ(shapeAt(shape, d), shapeAt(shape, -d));
            EXPECT_GE(shapeAt(shape, d), shapeAt(shape, d + 0.01)) << "falls outwards";
            EXPECT_LE(shapeAt(shape, d), 1);
        }
    }
}

RC_GTEST_PROP(TransferFunction, IsTheMeanOfColoursByOpacityAndTheLargestOpacity, ()) {
    const TransferFunction function = anyFunction();
    const double height = 3 * share() - 1;
    Vec3 low(std::numeric_limits<double>::infinity());
    Vec3 high(0);
    double largest = 0;
    for (const TransferPrimitive& primitive : function.primitives) {
        const double opacity =
            evaluate({HeightUnit::Relative, {primitive}}, height).opacity;  // alone
        largest = std::max(largest, opacity);
        if (opacity == 0)
            continue;
        low = glm::min(low, primitive.colour * primitive.colour);
        high = glm::max(high, primitive.colour * primitive.colour);
    }
    const Tint tint = evaluate(function, height);
    RC_ASSERT(tint.opacity == largest);
    for (int i = 0; i < 3 && largest > 0; ++i) {
        RC_ASSERT(tint.colour[i] >= low[i] - 1e-12);
        RC_ASSERT(tint.colour[i] <= high[i] + 1e-12);
    }
    if (largest == 0)
        RC_ASSERT(tint == Tint{});
}

RC_GTEST_PROP(TransferFunction, DoesNotDependOnTheOrderOfItsPrimitives, ()) {
    TransferFunction function = anyFunction();
    const double height = share();
    const Tint before = evaluate(function, height);
    std::reverse(function.primitives.begin(), function.primitives.end());
    const Tint after = evaluate(function, height);
    RC_ASSERT(after.opacity == before.opacity);
    RC_ASSERT(glm::length(after.colour - before.colour) < 1e-12);
}

RC_GTEST_PROP(TransferFunction, TwoBlendsOneWidthApartAreALinearRamp, ()) {
    TransferPrimitive a = anyPrimitive();
    a.shape = PrimitiveShape::Blend;
    a.opacity = 1;
    TransferPrimitive b = a;
    b.centre = a.centre + a.width;
    b.colour = anyPrimitive().colour;
    const double t = share();
    const Tint tint = evaluate({HeightUnit::Relative, {a, b}}, a.centre + t * a.width);
    const Vec3 expected = glm::mix(a.colour * a.colour, b.colour * b.colour, t);
    RC_ASSERT(tint.opacity > 1 - 1e-9);
    RC_ASSERT(glm::length(tint.colour - expected) < 1e-9);
}

TEST(HypsometricTints, AreOpaqueRampsFromMeadowToSnow) {
    const TransferFunction tints = hypsometricTints();
    ASSERT_TRUE(validate(tints).ok());
    for (int i = 0; i <= 1000; ++i) {
        const Tint tint = evaluate(tints, i / 1000.0);
        EXPECT_NEAR(tint.opacity, 1, 1e-9) << i;
        if (i % 200 == 100) {  // between two of them
            const Vec3 low = evaluate(tints, (i - 100) / 1000.0).colour;
            const Vec3 high = evaluate(tints, (i + 100) / 1000.0).colour;
            EXPECT_LT(glm::length(tint.colour - (low + high) / 2.0), 1e-9) << i;
        }
    }
    EXPECT_LT(glm::length(evaluate(tints, 0).colour - Vec3(0.12, 0.19, 0.06)), 1e-12);
    EXPECT_LT(glm::length(evaluate(tints, 1).colour - Vec3(0.86, 0.89, 0.93)), 1e-12);
}

TEST(TransferFunction, ARefusalNamesThePrimitiveAndTheField) {
    const auto refusal = [](const TransferPrimitive& second) {
        return std::string(validate({HeightUnit::Relative, {{}, second}}).message());
    };
    EXPECT_EQ(refusal({}), "");
    EXPECT_THAT(refusal({.width = 0}), testing::HasSubstr("primitives[1].width is 0"));
    EXPECT_THAT(refusal({.centre = 2e6}), testing::HasSubstr("primitives[1].centre"));
    EXPECT_THAT(refusal({.colour = {0, 0, 1.5}}), testing::HasSubstr("primitives[1].colour[2]"));
    EXPECT_THAT(refusal({.opacity = -1}), testing::HasSubstr("primitives[1].opacity"));
    const TransferFunction many{HeightUnit::Relative,
                                std::vector<TransferPrimitive>(kMaxTransferPrimitives + 1)};
    EXPECT_THAT(std::string(validate(many).message()), testing::HasSubstr("33 entries"));
}

}  // namespace
}  // namespace eyrie::fabric
