// SPDX-License-Identifier: Apache-2.0
// What a floor looks like under lights, against the formulas in double precision.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "renderer/renderer.h"
#include "tests/renderer/mesh/temporary_folder.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

using fabric::Vec3;
using TriangleMesh = eyrie::import::TriangleMesh;

constexpr int kSize = 96;
constexpr double kEyeHeight = 10;

/// A white square of 16 metres around the origin, facing up, of cells of `cellMetres`.
TriangleMesh floorOf(double cellMetres) {
    TriangleMesh mesh;
    const auto cells = static_cast<std::uint32_t>(16 / cellMetres);
    for (std::uint32_t y = 0; y <= cells; ++y)
        for (std::uint32_t x = 0; x <= cells; ++x)
            mesh.positions.emplace_back(x * cellMetres - 8, y * cellMetres - 8, 0);
    for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t at = y * (cells + 1) + x;
            mesh.triangles.push_back({at, at + 1, at + cells + 2});
            mesh.triangles.push_back({at, at + cells + 2, at + cells + 1});
        }
    return mesh;
}

class Lighting : public testing::Test {
protected:
    void SetUp() override { renderer_ = test::makeRenderer(); }

    /// The floor from straight above its middle.
    fabric::Image draw(fabric::Scene scene, double cellMetres, fabric::Shading shading,
                       const fabric::Mat4& transform = fabric::Mat4(1.0),
                       const fabric::FileLights& ofFile = {}) {
        const std::string path = folder_.file("floor.eym");
        TriangleMesh mesh = floorOf(cellMetres);
        mesh.lights = ofFile;
        EXPECT_TRUE(import::importMesh(mesh, path).ok());
        fabric::SceneObject object;
        object.name = "floor";
        object.path = path;
        object.colour = Vec3(1);
        object.worldFromObject = transform;
        scene.objects = {object};
        scene.ambient = 0.1;
        const auto opened = renderer_->openScene(scene);
        EXPECT_TRUE(opened.ok()) << opened.status();
        fabric::FrameData frame;
        frame.camera = {middle_ + Vec3(0, 0, kEyeHeight), middle_, Vec3(0, 1, 0), 60};
        frame.shading = shading;
        fabric::ChannelTask task;
        task.viewWidth = task.viewHeight = kSize;
        task.pixelViewport = {0, 0, kSize, kSize};
        auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        EXPECT_EQ(result->image.area, task.pixelViewport);
        return result->image;
    }

    /// Where the floor is seen in a pixel, world space.
    Vec3 placeAt(int x, int y) const {
        const double half = std::tan(glm::radians(30.0)) * kEyeHeight;
        const auto across = [&](int i) { return (2 * (i + 0.5) / kSize - 1) * half; };
        return middle_ + Vec3(across(x), across(y), 0);
    }

    /// As docs say a light shines on the floor: diffuse by Lambert, gloss by Blinn.
    double expected(const Vec3& place, const Vec3& towardsLight, double arriving) const {
        const Vec3 towardsEye = glm::normalize(middle_ + Vec3(0, 0, kEyeHeight) - place);
        const double gloss = glm::normalize(towardsLight + towardsEye).z;
        const double lit = 0.1 + 0.9 * arriving * towardsLight.z +
                           0.08 * arriving * std::pow(std::max(gloss, 0.0), 40.0);
        return std::sqrt(std::clamp(lit, 0.0, 1.0)) * 255;
    }

    /// What a spot's cone lets through to `place`, as glTF's KHR_lights_punctual says it.
    static double letThrough(const fabric::LightCone& cone, const Vec3& fromLight) {
        const double degrees =
            glm::degrees(std::acos(glm::dot(glm::normalize(fromLight), glm::normalize(cone.axis))));
        if (degrees <= cone.innerDegrees)
            return 1;
        if (degrees >= cone.outerDegrees)
            return 0;
        const auto cosine = [](double angle) { return std::cos(glm::radians(angle)); };
        const double part = (cosine(degrees) - cosine(cone.outerDegrees)) /
                            (cosine(cone.innerDegrees) - cosine(cone.outerDegrees));
        return part * part;
    }

    /// Also that all of a cone shows: what it lights fully, in part and not at all.
    void expectSpotLit(const fabric::Image& image, const fabric::PointLight& light,
                       double levels) const {
        std::array<int, 3> pixels{};
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const Vec3 place = placeAt(x, y);
                const Vec3 way = light.positionMetres - place;
                const double part = glm::length(way) / light.reachMetres;
                const double through = letThrough(*light.cone, -way);
                const double level =
                    expected(place, glm::normalize(way), through / (1 + part * part));
                const auto at = static_cast<std::size_t>(y * kSize + x);
                ASSERT_NEAR(image.colour[at].g, level, levels)
                    << "pixel " << x << ", " << y << ", to which " << through << " is let through";
                ++pixels[through == 0 ? 0 : through < 1 ? 1 : 2];
            }
        for (const int count : pixels) EXPECT_GT(count, kSize * kSize / 40);
    }

    void expectPointLit(const fabric::Image& image, const fabric::PointLight& light,
                        double levels) const {
        double brightest = 0;
        double darkest = 255;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const Vec3 place = placeAt(x, y);
                const Vec3 way = light.positionMetres - place;
                const double part = glm::length(way) / light.reachMetres;
                const double level = expected(place, glm::normalize(way), 1 / (1 + part * part));
                const auto at = static_cast<std::size_t>(y * kSize + x);
                ASSERT_NEAR(image.colour[at].g, level, levels) << "pixel " << x << ", " << y;
                brightest = std::max(brightest, level);
                darkest = std::min(darkest, level);
            }
        EXPECT_GT(brightest, darkest + 50) << "the light should show";
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_;
    Vec3 middle_{0, 0, 0};
};

TEST_F(Lighting, OfAPointFallsOffAsTheFormulaSays) {
    const fabric::PointLight light{Vec3(2, -1, 1.5), Vec3(1), 3};
    fabric::Scene scene;
    scene.pointLights = {light};
    expectPointLit(draw(scene, 4, fabric::Shading::Smooth), light, 1.5);
}

TEST_F(Lighting, OfAPointIsTheSameFarFromTheOriginAndOnATurnedObject) {
    middle_ = Vec3(5e5, 4.5e6, 300);
    const fabric::PointLight light{middle_ + Vec3(-1, 2, 2), Vec3(1), 4};
    fabric::Scene scene;
    scene.pointLights = {light};
    fabric::Mat4 turned = glm::translate(fabric::Mat4(1.0), middle_);
    turned = glm::rotate(turned, 1.0, Vec3(0, 0, 1));
    expectPointLit(draw(scene, 4, fabric::Shading::Smooth, glm::scale(turned, Vec3(2))), light,
                   1.5);
    expectPointLit(draw(scene, 4, fabric::Shading::Smooth, glm::scale(turned, Vec3(2, 3, 1))),
                   light, 1.5);
}

TEST_F(Lighting, AtVerticesIsTheSameWhereVerticesAreDense) {
    const fabric::PointLight light{Vec3(1, 0, 2), Vec3(1), 4};
    fabric::Scene scene;
    scene.pointLights = {light};
    expectPointLit(draw(scene, 0.0625, fabric::Shading::Gouraud), light, 2);
    // Light between vertices is interpolated: the bright spot inside a coarse cell is not seen.
    const fabric::Image coarse = draw(scene, 16, fabric::Shading::Gouraud);
    const fabric::Image exact = draw(scene, 16, fabric::Shading::Smooth);
    const std::size_t middle = kSize / 2 * kSize + kSize / 2;
    EXPECT_LT(coarse.colour[middle].g + 30, exact.colour[middle].g);
}

fabric::PointLight slantedSpot(const Vec3& middle) {
    return {middle + Vec3(-1.5, -1, 5), Vec3(1), 8,
            fabric::LightCone{Vec3(0.6, 0.2, -2.5), 15, 35}};
}

TEST_F(Lighting, OfASpotIsAllInsideItsConeNoneOutsideAndFadesBetween) {
    fabric::Scene scene;
    scene.pointLights = {slantedSpot(middle_)};
    const fabric::PointLight& light = scene.pointLights[0];
    expectSpotLit(draw(scene, 4, fabric::Shading::Smooth), light, 1.5);
    expectSpotLit(draw(scene, 4, fabric::Shading::Flat), light, 1.5);
    // Where the cone begins and ends, lines between vertices cut the corner.
    expectSpotLit(draw(scene, 0.0625, fabric::Shading::Gouraud), light, 5);
}

TEST_F(Lighting, OfASpotIsTheSameFarFromTheOriginAndOnATurnedObject) {
    middle_ = Vec3(5e5, 4.5e6, 300);
    fabric::Scene scene;
    scene.pointLights = {slantedSpot(middle_)};
    fabric::Mat4 turned = glm::translate(fabric::Mat4(1.0), middle_);
    turned = glm::rotate(turned, 1.0, Vec3(0, 0, 1));
    for (const Vec3& scale : {Vec3(2), Vec3(2, 3, 1)})
        expectSpotLit(draw(scene, 4, fabric::Shading::Smooth, glm::scale(turned, scale)),
                      scene.pointLights[0], 1.5);
}

TEST_F(Lighting, OfASpotWithoutAPenumbraEndsAtOnce) {
    fabric::Scene scene;
    scene.pointLights = {{Vec3(0, 0, 5), Vec3(1), 8, fabric::LightCone{Vec3(0, 0, -1), 30, 30}}};
    const fabric::Image image = draw(scene, 4, fabric::Shading::Smooth);
    const auto levelAt = [&](int x) {
        return image.colour[static_cast<std::size_t>(kSize / 2 * kSize + x)].g;
    };
    const double radius = 5 * std::tan(glm::radians(30.0));
    for (int x = 0; x < kSize; ++x) {
        const Vec3 way = scene.pointLights[0].positionMetres - placeAt(x, kSize / 2);
        const double from = std::hypot(way.x, way.y);
        const double part = glm::length(way) / 8;
        const double lit = expected(placeAt(x, kSize / 2), glm::normalize(way),
                                    from < radius ? 1 / (1 + part * part) : 0);
        if (std::abs(from - radius) > 0.1) {
            EXPECT_NEAR(levelAt(x), lit, 1.5) << "pixel " << x;
        }
    }
}

TEST_F(Lighting, OfSpotsAddsUpWithLightsThatHaveNoCone) {
    const fabric::PointLight spot = slantedSpot(middle_);
    const auto draws = [&](bool hasSpot, bool hasOther) {
        fabric::Scene scene;
        scene.lights = {{Vec3(0, 0.6, -0.8), hasOther ? Vec3(0, 0.3, 0) : Vec3(0)}};
        scene.pointLights = {{Vec3(2, 2, 3), hasOther ? Vec3(0, 0.2, 0) : Vec3(0), 5}};
        if (hasSpot)
            scene.pointLights.push_back(spot);
        return draw(scene, 4, fabric::Shading::Smooth);
    };
    const fabric::Image both = draws(true, true);
    const fabric::Image alone = draws(true, false);
    const fabric::Image others = draws(false, true);
    const auto light = [](fabric::Rgba shown) { return std::pow(shown.g / 255.0, 2); };
    for (std::size_t at = 0; at < both.colour.size(); at += 7)
        EXPECT_NEAR(
            both.colour[at].g,
            std::sqrt(std::min(light(alone.colour[at]) + light(others.colour[at]) - 0.1, 1.0)) *
                255,
            3)
            << at;
}

TEST_F(Lighting, OfBothKindsAddsUp) {
    const fabric::PointLight point{Vec3(2, 2, 3), Vec3(0, 0.5, 0), 5};
    fabric::Scene scene;
    scene.lights = {{Vec3(0, 0.6, -0.8), Vec3(0, 0.5, 0)}};
    scene.pointLights = {point};
    const fabric::Image image = draw(scene, 4, fabric::Shading::Smooth);
    for (const auto& [x, y] : {std::pair(5, 5), {48, 48}, {70, 60}, {95, 0}}) {
        const Vec3 place = placeAt(x, y);
        const Vec3 way = point.positionMetres - place;
        const double part = glm::length(way) / point.reachMetres;
        const double distant = std::pow(expected(place, Vec3(0, -0.6, 0.8), 0.5) / 255, 2);
        const double lit = distant + 0.9 * 0.5 / (1 + part * part) * glm::normalize(way).z;
        const auto at = static_cast<std::size_t>(y * kSize + x);
        EXPECT_NEAR(image.colour[at].g, std::sqrt(std::min(lit, 1.0)) * 255, 1.5) << x;
        // No light is red or blue: what is left is the light from everywhere.
        EXPECT_NEAR(image.colour[at].r, std::sqrt(0.1) * 255, 1.5);
    }
}

TEST_F(Lighting, OfFilesShinesWhereTheSceneHasNone) {
    const fabric::FileLights ofFile{{}, {{Vec3(2, -1, 1.5), Vec3(1), 3}}};
    fabric::Mat4 turned = glm::rotate(fabric::Mat4(1.0), glm::radians(90.0), Vec3(0, 0, 1));
    turned = glm::scale(turned, Vec3(2));
    expectPointLit(draw({}, 4, fabric::Shading::Smooth, turned, ofFile),
                   {Vec3(2, 4, 3), Vec3(1), 6}, 1.5);

    fabric::Scene lit;
    lit.pointLights = {{Vec3(-2, 1, 2), Vec3(1), 4}};
    expectPointLit(draw(lit, 4, fabric::Shading::Smooth, turned, ofFile), lit.pointLights[0], 1.5);
}

TEST_F(Lighting, OfAFilesSpotTurnsWithItsObject) {
    const fabric::FileLights ofFile{
        {}, {{Vec3(-0.5, 0.75, 2.5), Vec3(1), 4, fabric::LightCone{Vec3(0.1, -0.3, -1), 15, 35}}}};
    fabric::Mat4 turned = glm::rotate(fabric::Mat4(1.0), glm::radians(90.0), Vec3(0, 0, 1));
    turned = glm::scale(turned, Vec3(2));
    expectSpotLit(draw({}, 4, fabric::Shading::Smooth, turned, ofFile),
                  {Vec3(-1.5, -1, 5), Vec3(1), 8, fabric::LightCone{Vec3(0.3, 0.1, -1), 15, 35}},
                  1.5);
}

}  // namespace
}  // namespace eyrie
