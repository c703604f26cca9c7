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
    EXPECT_THAT(refusal(aimless), testing::HasSubstr("scene.lights.direction"));
    Scene glaring;
    glaring.ambient = 1.5;
    EXPECT_THAT(refusal(glaring), testing::HasSubstr("scene.ambient"));
}

}  // namespace
}  // namespace eyrie::fabric
