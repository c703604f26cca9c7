// SPDX-License-Identifier: Apache-2.0
// Pictures of the demo's data as they were when somebody last looked at them: what no bound
// speaks of (light, colours, lines) does not change unseen. They are kept in pictures/; to make
// them anew, run this test with EYRIE_WRITE_GOLDEN=1 and look at what git says has changed.
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/image_files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

/// Of a channel of 8 bits; more than a driver's rounding may differ by.
constexpr int kVisiblyDifferent = 12;
/// Of all pixels, for those on an edge that falls to the other side by rounding.
constexpr double kMaxShareVisiblyDifferent = 0.005;

struct Golden {
    std::string name;  ///< of the picture, and of the test
    std::string data;
    std::string camera;
    std::string look;  ///< empty for none
    std::vector<std::string> options;

    friend void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.name; }
};

constexpr const char* kAcrossTheMountain =
    R"({"eye":[585000,5170000,4200],"target":[597000,5193000,2600],"up":[0,0,1],"fovyDegrees":45})";
constexpr const char* kBesideTheArm =
    R"({"eye":[600000,5140000,9000],"target":[609000,5180000,5200],"up":[0,0,1],"fovyDegrees":30})";
constexpr const char* kAllLines = R"({
    "exaggeration": 1.5,
    "transfer": {"unit": "HEIGHT_UNIT_METRES", "primitives": [
        {"centre": 800, "width": 900, "colour": [0.25, 0.5, 0.25]},
        {"centre": 2200, "width": 1500, "colour": [0.6, 0.5, 0.4]},
        {"shape": "PRIMITIVE_SHAPE_BOX", "centre": 1500, "width": 60,
         "colour": [0.9, 0.1, 0.1], "opacity": 0.8}]},
    "slopeShading": 0.5, "contours": {"intervalMetres": 200, "widthPixels": 1},
    "saturation": 1.2, "tileBounds": true, "pageBounds": true})";
constexpr const char* kFrozenCut = R"({
    "levelTint": true,
    "cutCamera": {"eye": [585000, 5170000, 4200], "target": [597000, 5193000, 2600],
                  "up": [0, 0, 1], "fovyDegrees": 45}})";

std::vector<Golden> goldens() {
    const std::string terrain = "demo/mount_rainier.tif";
    const std::string all = "demo/scene.json";
    return {
        {"Scene", all, kBesideTheArm, "", {}},
        {"SceneFlat", all, kBesideTheArm, "", {"--shading", "flat", "--tau", "4"}},
        {"Terrain", terrain, kAcrossTheMountain, "", {}},
        {"TerrainLook", terrain, kAcrossTheMountain, kAllLines, {}},
        {"TerrainFrozenCut",
         terrain,
         R"({"eye":[560000,5150000,30000],"target":[597000,5190000,1000],"up":[0,0,1],"fovyDegrees":45})",
         kFrozenCut,
         {"--tau", "2"}},
        {"Wireframe", all, kBesideTheArm, "", {"--shading", "wireframe", "--tau", "8"}},
    };
}

class GoldenPicture : public testing::TestWithParam<Golden> {
protected:
    static void SetUpTestSuite() { folder_ = std::make_unique<test::TemporaryFolder>(); }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string render(const Golden& golden) {
        const std::string picture = folder_->path(golden.name + ".png");
        std::vector<std::string> arguments = {
            "render",   fmt::format("{}/{}", EYRIE_SOURCE_DIR, golden.data),
            "--camera", folder_->write("camera.json", golden.camera),
            "--size",   "320x180",
            "--cache",  folder_->path("cache"),
            "-o",       picture,
            "--quiet"};
        if (!golden.look.empty())
            arguments.insert(arguments.end(), {"--look", folder_->write("look.json", golden.look)});
        arguments.insert(arguments.end(), golden.options.begin(), golden.options.end());
        EXPECT_TRUE(test::succeeded(arguments));
        return picture;
    }

    static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> GoldenPicture::folder_;

bool isVisiblyDifferent(const fabric::Rgba& a, const fabric::Rgba& b) {
    const auto differ = [](std::uint8_t x, std::uint8_t y) {
        return std::abs(int{x} - int{y}) > kVisiblyDifferent;
    };
    return differ(a.r, b.r) || differ(a.g, b.g) || differ(a.b, b.b) || differ(a.a, b.a);
}

/// Keeps the picture for somebody to look at it.
std::string kept(const std::string& picture) {
    const auto place = std::filesystem::temp_directory_path() /
                       ("eyrie-golden-" + std::filesystem::path(picture).filename().string());
    std::filesystem::copy_file(picture, place, std::filesystem::copy_options::overwrite_existing);
    return place.string();
}

TEST_P(GoldenPicture, LooksAsItDid) {
    const std::string picture = render(GetParam());
    const std::string expected =
        fmt::format("{}/tests/golden/pictures/{}.png", EYRIE_SOURCE_DIR, GetParam().name);
    if (std::getenv("EYRIE_WRITE_GOLDEN") != nullptr) {
        std::filesystem::copy_file(picture, expected,
                                   std::filesystem::copy_options::overwrite_existing);
        GTEST_FAIL() << expected << " was made anew: look at it";
    }
    const auto was = test::readPng(expected);
    const auto is = test::readPng(picture);
    ASSERT_TRUE(was.ok()) << was.status();
    ASSERT_TRUE(is.ok()) << is.status();
    ASSERT_EQ(was->colour.size(), is->colour.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < was->colour.size(); ++i)
        different += isVisiblyDifferent(was->colour[i], is->colour[i]) ? 1 : 0;
    EXPECT_LE(static_cast<double>(different),
              kMaxShareVisiblyDifferent * static_cast<double>(was->colour.size()))
        << different << " pixels differ from " << expected << "; see " << kept(picture);
}

INSTANTIATE_TEST_SUITE_P(Demo, GoldenPicture, testing::ValuesIn(goldens()),
                         [](const auto& golden) { return golden.param.name; });

}  // namespace
}  // namespace eyrie
