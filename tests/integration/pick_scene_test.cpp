// SPDX-License-Identifier: Apache-2.0
// Which of a scene's objects is picked, and what is refused.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "renderer/import/terrain_import.h"
#include "renderer/pick/picker.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::Vec2;
using fabric::Vec3;
using pick::Picker;
using test::GridKind;

class PickScene : public testing::Test {
protected:
    /// A square of two triangles, 2 m a side, around a point, facing up or whichever way.
    fabric::SceneObject square(const std::string& name, const fabric::Mat4& worldFromObject) {
        import::TriangleMesh mesh;
        mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        const std::string path = folder_.path(name + ".eym");
        EXPECT_TRUE(import::importMesh(std::move(mesh), path).ok());
        return {.name = name, .path = path, .worldFromObject = worldFromObject};
    }

    absl::StatusOr<fabric::Picked> pick(const fabric::Scene& scene, const Camera& camera,
                                        const Vec2& place = {320, 240}) {
        auto picker = Picker::open(scene, {});
        EXPECT_TRUE(picker.ok()) << picker.status();
        return (*picker)->pick({camera, 640, 480, place});
    }

    static fabric::Mat4 movedTo(const Vec3& by) { return glm::translate(fabric::Mat4(1), by); }

    const Camera down_{{0.3, 0.1, 10}, {0.3, 0.1, 0}, {0, 1, 0}};
    const test::TemporaryFolder folder_;
};

TEST_F(PickScene, GivesTheNearestOfSeveralObjects) {
    fabric::Scene scene;
    scene.objects = {square("low", movedTo({0, 0, 1})), square("high", movedTo({0, 0, 3})),
                     square("aside", movedTo({5, 0, 6}))};
    const auto picked = pick(scene, down_);
    ASSERT_TRUE(picked.ok() && picked->has_value());
    EXPECT_EQ((*picked)->object, 1);
    EXPECT_LT(glm::length((*picked)->worldMetres - Vec3(0.3, 0.1, 3)), 1e-9);
    EXPECT_NEAR((*picked)->distanceMetres, 7, 1e-9);
    EXPECT_NEAR((*picked)->normal.z, 1, 1e-9);
    EXPECT_NEAR((*picked)->pixelMetres, 2 * 7 * std::tan(M_PI / 8) / 480, 1e-9);
    EXPECT_FALSE((*picked)->elevationMetres.has_value());
}

TEST_F(PickScene, MeetsNothingBesideBehindAndInAnEmptyScene) {
    fabric::Scene scene;
    EXPECT_EQ(*pick(scene, down_), fabric::Picked());
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    EXPECT_EQ(*pick(scene, down_, {0, 0}), fabric::Picked());
    EXPECT_EQ(*pick(scene, {{0, 0, 10}, {0, 0, 20}, {0, 1, 0}}), fabric::Picked());
}

TEST_F(PickScene, LeavesBacksOutWhereThePictureDoes) {
    const Camera up{{0.3, 0.1, -10}, {0.3, 0.1, 0}, {0, 1, 0}};
    fabric::Scene scene;
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    const auto back = pick(scene, up);
    ASSERT_TRUE(back.ok() && back->has_value());
    EXPECT_NEAR((*back)->normal.z, -1, 1e-9);
    scene.objects[0].singleSided = true;
    EXPECT_EQ(*pick(scene, up), fabric::Picked());
    EXPECT_TRUE(pick(scene, down_)->has_value());
}

TEST_F(PickScene, RefusesPlacesOutsideThePictureAndWhatIsNoCamera) {
    fabric::Scene scene;
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec2& place : {Vec2(-0.01, 5), Vec2(5, 480.01), Vec2(nan, 5), Vec2(5, nan)})
        EXPECT_TRUE(absl::IsInvalidArgument(pick(scene, down_, place).status()));
    Camera bad = down_;
    bad.eye.x = nan;
    EXPECT_TRUE(absl::IsInvalidArgument(pick(scene, bad).status()));
    const auto picker = Picker::open(scene, {});
    EXPECT_TRUE(absl::IsInvalidArgument((*picker)->pick({down_, 0, 480, {0, 0}}).status()));
    EXPECT_TRUE(absl::IsInvalidArgument((*picker)->pick({down_, 640, 480, {1, 1}, nan}).status()));
    scene.objects[0].path = folder_.path("absent.eym");
    EXPECT_TRUE(absl::IsNotFound(Picker::open(scene, {}).status()));
}

TEST_F(PickScene, EndsWhenItsTimeIsOver) {
    fabric::Scene scene;
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    const auto picker = Picker::open(scene, {});
    ASSERT_TRUE(picker.ok());
    EXPECT_TRUE(absl::IsDeadlineExceeded(
        (*picker)->pick({down_, 640, 480, {320, 240}}, Picker::Clock::now()).status()));
}

/// Coarser data do not stand in.
TEST_F(PickScene, NamesThePageThatIsDamaged) {
    const std::string path = folder_.path("terrain.eyt");
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Noise, 300, 300, 5);
    ASSERT_TRUE(import::importTerrain(grid, {"grid", "", 0}, path, {}).ok());
    const auto size = std::filesystem::file_size(path);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    for (std::uintmax_t at = 4096; at < size / 2; at += 4096)
        file.seekp(static_cast<std::streamoff>(at)).put('\x5a');
    file.close();
    fabric::Scene scene;
    scene.objects.push_back({.name = "t", .kind = fabric::ObjectKind::Terrain, .path = path});
    int refused = 0;
    for (int k = 0; k < 9; ++k) {
        const int column = 40 + 100 * (k % 3);
        const int row = 40 + 100 * (k / 3);
        const fabric::Vec2 at =
            grid.origin + grid.perColumn * (1.0 * column) + grid.perRow * (1.0 * row);
        const auto picked = pick(scene, {{at.x, at.y, 9000}, {at.x, at.y, 0}, {0, 1, 0}});
        if (picked.ok())
            continue;
        ++refused;
        const std::string message = picked.status().ToString();
        EXPECT_TRUE(absl::IsDataLoss(picked.status())) << message;
        EXPECT_NE(message.find(path), std::string::npos) << message;
    }
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace eyrie
