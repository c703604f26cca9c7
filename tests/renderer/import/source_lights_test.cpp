// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/source_lights.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::import {
namespace {

using fabric::Vec3;
using Kind = SourceLight::Kind;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

fabric::FileLights lightsFrom(const std::vector<SourceLight>& lights) {
    std::vector<std::string> notes;
    fabric::FileLights result = import::lightsFrom(lights, notes);
    EXPECT_THAT(notes, IsEmpty());
    return result;
}

double arriving(const fabric::PointLight& light, double distance) {
    const double part = distance / light.reachMetres;
    return light.colour.x / (1 + part * part);
}

RC_GTEST_PROP(SourceLights, AreAsBrightFarAwayAsTheSourceSaysAndNeverBrighterThanWhite, ()) {
    const auto number = [](int least, int most) {
        return std::pow(10.0, *rc::gen::inRange(10 * least, 10 * most) / 10.0);
    };
    const double constant = *rc::gen::arbitrary<bool>() ? number(-2, 3) : 0;
    const double quadratic = number(-4, 4);
    const double intensity = number(-3, 6);
    const SourceLight source{Kind::Point, Vec3(1, 2, 3), Vec3(intensity), constant, 0, quadratic};
    std::vector<std::string> notes;
    const fabric::FileLights lights = import::lightsFrom({&source, 1}, notes);
    RC_ASSERT(lights.points.size() == 1U);
    const fabric::PointLight& light = lights.points[0];
    RC_ASSERT(light.colour.x <= 1 + 1e-12);
    const double far = 1e5 * (light.reachMetres + std::sqrt(constant / quadratic));
    const double said = intensity / (constant + quadratic * far * far);
    RC_ASSERT(std::abs(arriving(light, far) / said - 1) < 1e-6);
}

TEST(SourceLights, ThatFallOffWithTheDistanceAreHalfAsBrightWhereTheSourceHasItSo) {
    const auto lights = lightsFrom({{Kind::Point, Vec3(0), Vec3(0.8), 2, 0.5, 0}});
    EXPECT_THAT(lights.points, ElementsAre(fabric::PointLight{Vec3(0), Vec3(0.4), 4}));
}

TEST(SourceLights, ThatDoNotFallOffReachEverywhere) {
    const auto lights = lightsFrom({{Kind::Point, Vec3(5, 0, 0), Vec3(1, 0, 0), 1, 0, 0}});
    ASSERT_EQ(lights.points.size(), 1U);
    EXPECT_NEAR(arriving(lights.points[0], 1e6), 1, 1e-9);
}

TEST(SourceLights, KeepTheirShareWhereOneIsTooBright) {
    const auto lights = lightsFrom({{Kind::Distant, Vec3(0, 0, -2), Vec3(100, 50, 0)},
                                    {Kind::Distant, Vec3(0, 3, 0), Vec3(10)},
                                    {Kind::Point, Vec3(0), Vec3(50), 1, 0, 0.25}});
    EXPECT_THAT(lights.distant,
                ElementsAre(fabric::DirectionalLight{Vec3(0, 0, -1), Vec3(1, 0.5, 0)},
                            fabric::DirectionalLight{Vec3(0, 1, 0), Vec3(0.1)}));
    EXPECT_THAT(lights.points, ElementsAre(fabric::PointLight{Vec3(0), Vec3(0.5), 2}));
}

SourceLight spotOf(const fabric::LightCone& cone) {
    return {Kind::Point, Vec3(0), Vec3(1), 1, 0, 0, cone};
}

TEST(SourceLights, ThatAreSpotsKeepTheirCone) {
    const fabric::LightCone cone{Vec3(0, 1, 0), 10, 20};
    EXPECT_EQ(lightsFrom({spotOf(cone)}).points.at(0).cone, cone);
    EXPECT_FALSE(lightsFrom({{Kind::Point, Vec3(0), Vec3(1)}}).points.at(0).cone.has_value());
}

TEST(SourceLights, OfNoLightAreLeftOut) {
    EXPECT_EQ(lightsFrom({{Kind::Point, Vec3(0), Vec3(0)}}).count(), 0U);
    EXPECT_EQ(lightsFrom({{Kind::Point, Vec3(0), Vec3(1e-320), 0, 0, 1}}).count(), 0U);
    EXPECT_EQ(lightsFrom({{Kind::Point, Vec3(0), Vec3(1), 0, 0, 1},
                          {Kind::Distant, Vec3(0, 0, -1), Vec3(1e300)}})
                  .count(),
              1U);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double endless = std::numeric_limits<double>::infinity();
    for (const SourceLight& unsound :
         {SourceLight{Kind::Point, Vec3(none), Vec3(1)},
          SourceLight{Kind::Distant, Vec3(0), Vec3(1)},
          SourceLight{Kind::Point, Vec3(0, endless, 0), Vec3(1)},
          SourceLight{Kind::Point, Vec3(0), Vec3(1, -1, 1)},
          SourceLight{Kind::Point, Vec3(0), Vec3(endless)},
          SourceLight{Kind::Point, Vec3(0), Vec3(1), 1, 0, -3}, spotOf({Vec3(0), 10, 20}),
          spotOf({Vec3(0, 0, 1), 30, 20}), spotOf({Vec3(0, 0, 1), -1, 20}),
          spotOf({Vec3(0, 0, 1), 0, none}), spotOf({Vec3(0, 0, 1), 0, 91})}) {
        std::vector<std::string> notes;
        EXPECT_EQ(import::lightsFrom({&unsound, 1}, notes).count(), 0U);
        EXPECT_THAT(notes, ElementsAre(HasSubstr("left out 1 of 1 lights")));
    }
}

TEST(SourceLights, AreTheBrightestInTheMiddleWhereThereAreTooMany) {
    TriangleMesh mesh;
    mesh.positions = {Vec3(0), Vec3(100, 0, 0)};
    for (int i = 0; i < 7; ++i) mesh.lights.points.push_back({Vec3(i * 20, 0, 0), Vec3(1), 10});
    limitLights(mesh);
    ASSERT_EQ(mesh.lights.points.size(), 4U);
    EXPECT_EQ(mesh.lights.points.front().positionMetres.x, 20);
    EXPECT_EQ(mesh.lights.points.back().positionMetres.x, 80);
    EXPECT_THAT(mesh.notes, ElementsAre(HasSubstr("left out 3 of 7 lights")));
    limitLights(mesh);
    EXPECT_EQ(mesh.notes.size(), 1U);
}

}  // namespace
}  // namespace eyrie::import
