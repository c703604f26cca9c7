// SPDX-License-Identifier: Apache-2.0
#include "fabric/scene.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>

namespace eyrie::fabric {
namespace {

Scene sceneWith(const SceneObject& object) {
    Scene scene;
    scene.objects = {object};
    return scene;
}

SceneObject bunny() { return {"bunny", ObjectKind::Mesh, "bunny.eym", Mat4(1.0), Vec3(0.5)}; }

std::string refusal(const Scene& scene) { return std::string(validate(scene).message()); }

TEST(Scene, AnEmptyOneAndOneOfAnObjectAreValid) {
    EXPECT_TRUE(validate(Scene{}).ok());
    EXPECT_TRUE(validate(sceneWith(bunny())).ok());
}

TEST(Scene, ARefusedTransformNamesItsObject) {
    SceneObject singular = bunny();
    singular.worldFromObject[2][2] = 0;
    SceneObject projective = bunny();
    projective.worldFromObject[1][3] = 0.5;
    SceneObject infinite = bunny();
    infinite.worldFromObject[3][0] = std::numeric_limits<double>::infinity();
    for (const SceneObject& object : {singular, projective, infinite})
        EXPECT_THAT(refusal(sceneWith(object)), testing::HasSubstr("'bunny'"));
}

TEST(Scene, WhatIsWrongIsNamedByItsPlaceInTheScene) {
    using testing::StartsWith;
    Scene scene;
    scene.objects = {bunny(), bunny()};
    scene.objects[1].worldFromObject[2][2] = 0;
    EXPECT_THAT(refusal(scene), StartsWith("scene.objects[1] 'bunny': "));
    scene.objects[1] = bunny();
    scene.objects[0].path.clear();
    EXPECT_THAT(refusal(scene), StartsWith("scene.objects[0] 'bunny' lacks its path"));
    scene.objects.clear();
    scene.lights = {{}, {Vec3(0), Vec3(1)}};
    EXPECT_THAT(refusal(scene), StartsWith("scene.lights[1].direction must"));
    scene.lights.clear();
    scene.pointLights = {{}, {Vec3(0), Vec3(1), 0}};
    EXPECT_THAT(refusal(scene), StartsWith("scene.pointLights[1].reach is 0"));
    scene.pointLights[1] = {Vec3(0), Vec3(1), 1, LightCone{Vec3(0, 0, -1), 0, 91}};
    EXPECT_THAT(refusal(scene), StartsWith("scene.pointLights[1].cone.outerDegrees is 91"));
}

TEST(Scene, AnObjectIsNotMovedOrScaledWhereNoCameraSeesAllOfIt) {
    for (const int column : {1, 3}) {
        SceneObject far = bunny();
        far.worldFromObject[column][1] = -1e14;
        EXPECT_TRUE(validate(sceneWith(far)).ok());
        far.worldFromObject[column][1] = -1.1e14;
        EXPECT_THAT(refusal(sceneWith(far)),
                    testing::HasSubstr("is -1.1e+14; it must be from -1e+14 to 1e+14"));
    }
}

TEST(Scene, AnObjectNeedsANameAndAPath) {
    SceneObject nameless = bunny();
    nameless.name.clear();
    EXPECT_THAT(refusal(sceneWith(nameless)), testing::HasSubstr("name"));
    SceneObject pathless = bunny();
    pathless.path.clear();
    EXPECT_THAT(refusal(sceneWith(pathless)), testing::HasSubstr("path"));
}

TEST(Scene, LightsAreFewAndHaveADirection) {
    Scene crowded;
    crowded.lights.resize(kMaxLights + 1);
    EXPECT_THAT(refusal(crowded), testing::HasSubstr("5 lights; at most 4"));
    Scene aimless;
    aimless.lights = {{Vec3(0.0), Vec3(1.0)}};
    EXPECT_THAT(refusal(aimless), testing::HasSubstr("scene.lights[0].direction"));
    Scene glaring;
    glaring.ambient = 1.5;
    EXPECT_THAT(refusal(glaring), testing::HasSubstr("scene.ambient"));
}

Scene sceneLitBy(const LightCone& cone) {
    Scene scene;
    scene.pointLights = {{Vec3(0), Vec3(1), 1, cone}};
    return scene;
}

TEST(Scene, ASpotsConeLightsUpToHalfOfTheSpaceAndSaysWhatIsWrongWithIt) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const Vec3 down(0, 0, -1);
    EXPECT_TRUE(validate(sceneLitBy({})).ok());
    EXPECT_TRUE(validate(sceneLitBy({down, 0, 90})).ok());
    EXPECT_TRUE(validate(sceneLitBy({down * 7.0, 30, 30})).ok()) << "a hard edge";
    using testing::HasSubstr;
    for (const double outer : {0.0, -5.0, 90.001, 180.0, kNone})
        EXPECT_THAT(refusal(sceneLitBy({down, 0, outer})), HasSubstr("cone.outerDegrees is"));
    for (const double inner : {-0.1, 30.1, kNone})
        EXPECT_THAT(refusal(sceneLitBy({down, inner, 30})), HasSubstr("cone.innerDegrees is"));
    for (const Vec3& axis : {Vec3(0), Vec3(0, kNone, 1)})
        EXPECT_THAT(refusal(sceneLitBy({axis, 0, 30})), HasSubstr("cone.axis must be"));
}

}  // namespace
}  // namespace eyrie::fabric
