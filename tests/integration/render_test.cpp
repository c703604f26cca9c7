// SPDX-License-Identifier: Apache-2.0
// From synthetic source to picture by the program alone: synth, import, info, render.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/image_files.h"
#include "tests/support/json.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using test::at;
using test::eyrie;
using test::JsonValue;
using test::number;
using test::parseJson;
using test::succeeded;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

std::string content(const std::string& path) {
    const auto text = test::readFile(path);
    EXPECT_TRUE(text.ok()) << text.status();
    return text.ok() ? *text : std::string();
}

/// A picture, its depth and its statistics, as the program wrote them.
struct Rendered {
    fabric::Image image;
    test::DepthPicture depth;
    JsonValue statistics;
};

/// A synthetic terrain and mesh, made and imported once.
class Render : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        ASSERT_TRUE(succeeded(
            {"synth", "terrain", "--size", "513", "--seed", "3", "-o", folder_->path("dem.tif")}));
        ASSERT_TRUE(succeeded(
            {"import", "terrain", folder_->path("dem.tif"), "-o", folder_->path("dem.eyt")}));
        ASSERT_TRUE(succeeded(
            {"synth", "mesh", "--size", "80000", "--seed", "3", "-o", folder_->path("ball.ply")}));
        ASSERT_TRUE(succeeded(
            {"import", "mesh", folder_->path("ball.ply"), "-o", folder_->path("ball.eym")}));
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string path(const std::string& name) { return folder_->path(name); }

    static JsonValue info(const std::string& name) {
        const test::Outcome outcome = eyrie({"info", path(name), "--json"});
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        return parseJson(outcome.output);
    }

    static std::string cameraFile(const std::string& json) {
        return folder_->write("camera.json", json);
    }

    /// A view of the terrain with sky above it.
    static std::string terrainCamera() {
        const JsonValue bounds = at(info("dem.eyt"), "bounds");
        const auto coordinate = [&](const char* corner, int axis) {
            return at(bounds, corner).list_value().values(axis).number_value();
        };
        const double x = (coordinate("min", 0) + coordinate("max", 0)) / 2;
        const double north = coordinate("max", 1), south = coordinate("min", 1);
        const double side = north - south;
        const double z = coordinate("max", 2);
        return cameraFile(
            fmt::format(R"({{"eye":[{},{},{}],"target":[{},{},{}],"up":[0,0,1],"fovyDegrees":50}})",
                        x, south - 0.3 * side, z + 0.2 * side, x, north, z));
    }

    static std::string meshCamera() {
        return cameraFile(R"({"eye":[0,-4,0.5],"target":[0,0,0],"up":[0,0,1],"fovyDegrees":40})");
    }

    static Rendered render(const std::string& data, const std::string& camera,
                           const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments = {
            "render", path(data),      "--camera", camera,          "--size",  "1280x720",
            "-o",     path("out.png"), "--depth",  path("out.pfm"), "--stats", path("out.json")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--tau") == more.end())
            arguments.insert(arguments.end(), {"--tau", "1"});
        EXPECT_TRUE(succeeded(arguments));
        Rendered rendered;
        if (auto image = test::readPng(path("out.png")); image.ok())
            rendered.image = *std::move(image);
        if (auto depth = test::readPfm(path("out.pfm")); depth.ok())
            rendered.depth = *std::move(depth);
        rendered.statistics = parseJson(content(path("out.json")));
        EXPECT_EQ(rendered.image.colour.size(), kPixels);
        EXPECT_EQ(rendered.depth.metres.size(), kPixels);
        for (const char* name : {"out.png", "out.pfm", "out.json"})
            std::filesystem::remove(path(name));
        return rendered;
    }

    static void expectDecompositionsEqual(const std::string& data, const std::string& camera) {
        const Rendered single = render(data, camera);
        ASSERT_EQ(single.image.colour.size(), kPixels);
        for (const auto& [count, compound] :
             {std::pair("2", "2D"), {"4", "2D"}, {"2", "DB"}, {"3", "DB"}}) {
            const Rendered parts =
                render(data, camera, {"--renderers", count, "--compound", compound});
            ASSERT_EQ(parts.image.colour.size(), kPixels);
            std::size_t different = 0;
            for (std::size_t i = 0; i < kPixels; ++i)
                different += parts.image.colour[i] == single.image.colour[i] &&
                                     parts.depth.metres[i] == single.depth.metres[i]
                                 ? 0
                                 : 1;
            fmt::print("{} over {} renderers, {}: {} pixels of {} differ\n", compound, count, data,
                       different, kPixels);
            EXPECT_EQ(different, 0U);
        }
    }

    static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> Render::folder_;

TEST_F(Render, InfoSaysWhatATerrainIs) {
    const JsonValue facts = info("dem.eyt");
    EXPECT_EQ(at(facts, "kind").string_value(), "terrain");
    EXPECT_GT(number(facts, "samples"), 500 * 500);
    EXPECT_GE(number(facts, "levels"), 3);
    EXPECT_NE(at(facts, "crs").string_value(), "");
    EXPECT_EQ(number(facts, "bytes"),
              static_cast<double>(std::filesystem::file_size(path("dem.eyt"))));
    EXPECT_GE(number(facts, "errorMetres.coarsest"), number(facts, "errorMetres.finest"));
}

TEST_F(Render, InfoSaysWhatAMeshIs) {
    const JsonValue facts = info("ball.eym");
    EXPECT_EQ(at(facts, "kind").string_value(), "mesh");
    EXPECT_NEAR(number(facts, "triangles"), 80000, 2000);
    EXPECT_GE(number(facts, "levels"), 1);
    EXPECT_EQ(number(facts, "bytes"),
              static_cast<double>(std::filesystem::file_size(path("ball.eym"))));
    EXPECT_GT(number(facts, "errorMetres.finest"), 0);
    EXPECT_LT(number(facts, "errorMetres.finest"), 1e-5);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(at(facts, "bounds.min").list_value().values(axis).number_value(), -1, 0.5);
        EXPECT_NEAR(at(facts, "bounds.max").list_value().values(axis).number_value(), 1, 0.5);
    }
}

TEST_F(Render, DepthIsAPfmFromTheBottomRowUpWithInfinityForTheSky) {
    render("dem.eyt", terrainCamera());
    ASSERT_TRUE(succeeded({"render", path("dem.eyt"), "--camera", path("camera.json"), "--size",
                           "320x200", "-o", path("small.png"), "--depth", path("small.pfm")}));
    EXPECT_TRUE(content(path("small.pfm")).starts_with("Pf\n320 200\n-1.0\n"));
    const auto depth = test::readPfm(path("small.pfm"));
    ASSERT_TRUE(depth.ok()) << depth.status();
    const auto metres = [&](int x, int y) {
        return depth->metres[static_cast<std::size_t>(y * depth->width + x)];
    };
    EXPECT_TRUE(std::isfinite(metres(160, 40))) << "the ground is below";
    EXPECT_LT(metres(160, 40), metres(160, 90)) << "and farther away higher up";
    EXPECT_EQ(metres(160, 199), INFINITY) << "the sky is above";
    for (const float value : depth->metres)
        ASSERT_TRUE(value > 0) << "no depth is 0, negative or not a number";
}

TEST_F(Render, PicturesAndDepthAgreeOnWhatIsCovered) {
    const Rendered ball = render("ball.eym", meshCamera());
    const fabric::Rgba background = ball.image.colour.front();
    std::size_t covered = 0;
    std::size_t disagree = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const bool hit = std::isfinite(ball.depth.metres[i]);
        covered += hit ? 1 : 0;
        disagree += hit == (ball.image.colour[i] == background) ? 1 : 0;
    }
    // A ball of radius 1 at 4 m fills about 500 pixels' diameter; the light may give some of it
    // the background's very colour.
    EXPECT_NEAR(static_cast<double>(covered), M_PI * 255 * 255, 60000);
    EXPECT_LT(disagree, covered / 100);
    const float centre = ball.depth.metres[kPixels / 2 + kWidth / 2];
    EXPECT_NEAR(centre, std::hypot(4, 0.5) - 1, 0.4);
}

TEST_F(Render, StatisticsAreNumbersByTheirAgreedNames) {
    const JsonValue facts = render("dem.eyt", terrainCamera()).statistics;
    EXPECT_EQ(number(facts, "width"), kWidth);
    EXPECT_EQ(number(facts, "height"), kHeight);
    EXPECT_EQ(number(facts, "tauAsked"), 1);
    EXPECT_GE(number(facts, "tauAchieved"), 0);
    EXPECT_TRUE(at(facts, "complete").bool_value());
    EXPECT_GT(number(facts, "triangles"), 100);
    EXPECT_EQ(number(facts, "points"), 0);
    EXPECT_GE(number(facts, "nodes"), 1);
    EXPECT_GE(number(facts, "pagesLoaded"), 1);
    EXPECT_GT(number(facts, "bytesLoaded"), 0);
    for (const char* stage : {"cull", "draw", "vertices", "fill", "readback", "encode", "total"})
        EXPECT_GE(number(facts, fmt::format("milliseconds.{}", stage)), 0);
    EXPECT_GT(number(facts, "milliseconds.vertices"), 0);
    EXPECT_NEAR(number(facts, "milliseconds.vertices") + number(facts, "milliseconds.fill"),
                number(facts, "milliseconds.draw"), 1e-6);
    EXPECT_NE(at(facts, "limitingStage").string_value(), "");
    EXPECT_NE(at(facts, "renderer.vendor").string_value(), "");
    EXPECT_NE(at(facts, "renderer.device").string_value(), "");
    EXPECT_EQ(at(facts, "renderer.software").kind_case(), JsonValue::kBoolValue);
}

TEST_F(Render, ATerrainOverSeveralRenderersIsThePictureOfOne) {
    expectDecompositionsEqual("dem.eyt", terrainCamera());
}

TEST_F(Render, AMeshOverSeveralRenderersIsThePictureOfOne) {
    expectDecompositionsEqual("ball.eym", meshCamera());
}

/// Here and by other processes: what is left out is in the error that is promised.
TEST_F(Render, LittleMemoryRaisesTheErrorThatIsPromised) {
    for (const std::vector<std::string>& processes :
         {std::vector<std::string>{}, {"--renderers", "1"}}) {
        const auto fine = [&](const std::string& memory) {
            std::vector<std::string> more = {"--tau", "0.1", "--memory", memory};
            more.insert(more.end(), processes.begin(), processes.end());
            return render("ball.eym", meshCamera(), more).statistics;
        };
        const JsonValue all = fine("1G");
        const JsonValue few = fine("400K");
        EXPECT_LE(number(all, "tauAchieved"), 0.1);
        EXPECT_GT(number(few, "tauAchieved"), 0.1);
        EXPECT_LT(number(few, "triangles"), number(all, "triangles") / 2);
        EXPECT_TRUE(at(few, "complete").bool_value());
    }
}

using HardCase28 = Render;

/// Bytes of the files that `eyrie render` leaves of a mesh on a terrain.
struct Still {
    std::string png;
    std::string pfm;

    bool operator==(const Still&) const = default;
};

/// Expected are the first run's bytes. llvmpipe's threads are what LP_NUM_THREADS says, and those
/// of each of five processes one.
TEST_F(HardCase28, StillsAreTheSameBytesInEveryRunAndForAnyThreadsAndProcesses) {
    folder_->write("both.json", R"({"objects":[{"terrain":"dem.eyt"},
        {"mesh":"ball.eym","transform":{"scale":2000,"translation":[507000,5207000,3000]}}]})");
    const std::string camera = cameraFile(
        R"({"eye":[503000,5202000,4500],"target":[508000,5208000,2500],"fovyDegrees":50})");
    const auto still = [&](const std::vector<std::string>& more, const std::string& threads) {
        std::vector<std::string> arguments = {
            "render", path("both.json"), "--camera", camera,        "--size", "640x360",
            "-o",     path("s.png"),     "--depth",  path("s.pfm"), "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(eyrie(arguments, {"LP_NUM_THREADS=" + threads}).exit, (test::Exit{0, 0}));
        return Still{content(path("s.png")), content(path("s.pfm"))};
    };
    const Still first = still({}, "8");
    EXPECT_TRUE(still({}, "8") == first) << "again";
    EXPECT_TRUE(still({}, "1") == first);
    EXPECT_TRUE(still({"--renderers", "5"}, "1") == first);
    EXPECT_TRUE(still({"--renderers", "5", "--compound", "DB"}, "1") == first);
}

TEST_F(Render, ASceneFilePlacesItsObjectsRelativeToItself) {
    folder_->write("scene.json", R"({"objects":[
        {"mesh":"ball.eym","transform":{"translation":[-1.5,0,0]}},
        {"name":"source","mesh":"ball.ply","transform":{"translation":[1.5,0,0]}}]})");
    const test::TemporaryFolder cache;
    const Rendered both = render("scene.json", meshCamera(), {"--cache", cache.path("imports")});
    const auto isHit = [&](int x) {
        return std::isfinite(
            both.depth.metres[kPixels / 2 + kWidth / 2 + static_cast<std::size_t>(x)]);
    };
    EXPECT_TRUE(isHit(-370) && isHit(370)) << "a ball to the left and one to the right";
    EXPECT_FALSE(isHit(0)) << "and a gap between them";
    EXPECT_EQ(test::namesIn(cache.path("imports")).size(), 2U)
        << "the source's import is kept, and where its source lies";
}

TEST_F(Render, ALookFileAndFlagsChangeHowTerrainIsShown) {
    const Rendered plain = render("dem.eyt", terrainCamera());
    folder_->write("look.json", R"({"exaggeration":3,"contours":{"intervalMetres":100}})");
    const std::string look = path("look.json");
    const Rendered lined =
        render("dem.eyt", terrainCamera(), {"--look", look, "--exaggeration", "1"});
    EXPECT_EQ(lined.depth.metres, plain.depth.metres) << "the flag goes before the file";
    EXPECT_NE(lined.image.colour, plain.image.colour);
    EXPECT_NE(render("dem.eyt", terrainCamera(), {"--look", look}).depth.metres,
              plain.depth.metres);
    EXPECT_NE(render("dem.eyt", terrainCamera(), {"--shading", "wireframe"}).image.colour,
              plain.image.colour);
}

TEST_F(Render, ALookThatCannotBeIsRefusedByName) {
    folder_->write("odd.json", R"({"saturation":9})");
    const auto errors = [&](const std::string& option, const std::string& value) {
        const test::Outcome outcome = eyrie({"render", path("dem.eyt"), "--camera", terrainCamera(),
                                             option, value, "-o", path("never.png")});
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0}));
        return outcome.errors;
    };
    EXPECT_NE(errors("--look", path("odd.json")).find("odd.json: look.saturation is 9; it must be"),
              std::string::npos);
    EXPECT_NE(errors("--exaggeration", "1e9").find("--exaggeration is 1000000000; expected -1000"),
              std::string::npos);
    EXPECT_NE(errors("--exaggeration", "nan").find("--exaggeration is nan; expected -1000"),
              std::string::npos);
}

TEST_F(Render, WritesJpegByItsName) {
    ASSERT_TRUE(succeeded({"render", path("ball.eym"), "--camera", meshCamera(), "--size", "64x64",
                           "-o", path("out.jpg")}));
    EXPECT_TRUE(content(path("out.jpg")).starts_with("\xff\xd8\xff"));
}

TEST_F(Render, ShowsAllOfTheSceneWhereNoCameraIsNamed) {
    ASSERT_TRUE(succeeded({"render", path("ball.eym"), "--size", "80x60", "-o", path("all.png"),
                           "--depth", path("all.pfm")}));
    const auto depth = test::readPfm(path("all.pfm"));
    ASSERT_TRUE(depth.ok()) << depth.status();
    int covered = 0;
    for (std::size_t i = 0; i < depth->metres.size(); ++i) {
        const bool isCovered = std::isfinite(depth->metres[i]);
        covered += isCovered ? 1 : 0;
        const std::size_t x = i % 80;
        const std::size_t y = i / 80;
        EXPECT_FALSE(isCovered && (x == 0 || x == 79 || y == 0 || y == 59)) << x << ", " << y;
    }
    EXPECT_GT(covered, 300);
}

TEST_F(Render, IsSilentOnStandardOutput) {
    const test::Outcome outcome = eyrie({"render", path("ball.eym"), "--camera", meshCamera(),
                                         "--size", "64x64", "--quiet", "-o", path("quiet.png")});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0}));
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(outcome.errors, "");
}

TEST_F(Render, SaysThatACompoundIsOfSeveralRenderers) {
    const auto errors = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"render", path("ball.eym"), "--camera", meshCamera(),
                                         "--size", "64x64", "-o", path("compound.png")});
        return eyrie(options).errors;
    };
    const std::string note = "--compound DB has no effect";
    EXPECT_NE(errors({"--compound", "DB"}).find(note), std::string::npos);
    EXPECT_EQ(errors({"--compound", "DB", "--quiet"}), "");
    EXPECT_EQ(errors({"--compound", "DB", "--renderers", "2"}).find(note), std::string::npos);
    EXPECT_EQ(errors({}).find("--compound"), std::string::npos);
}

TEST_F(Render, SaysThatARateOfPicturesIsOfAFlight) {
    const test::Outcome outcome =
        eyrie({"render", path("ball.eym"), "--fps", "10", "-o", path("rate.png")});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0}));
    EXPECT_NE(outcome.errors.find("--fps has no effect"), std::string::npos) << outcome.errors;
}

/// Pictures count rows from the top, depth from the bottom.
TEST_F(Render, WhatAPixelShowsIsWhereItsDepthSays) {
    const std::string camera = terrainCamera();
    const Rendered rendered = render("dem.eyt", camera);
    const auto picked = [&](const std::string& pixel) {
        return eyrie({"pick", path("dem.eyt"), "--camera", camera, "--size", "1280x720", "--pixel",
                      pixel, "--json"});
    };
    for (const auto& [x, y] : {std::pair(640, 400), std::pair(200, 600), std::pair(1100, 700)}) {
        const test::Outcome outcome = picked(fmt::format("{},{}", x, y));
        ASSERT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        const JsonValue point = parseJson(outcome.output);
        const double focal = 360 / std::tan(25 * M_PI / 180);
        const double perDepth = std::hypot(1, (x + 0.5 - 640) / focal, (y + 0.5 - 360) / focal);
        const auto row = static_cast<std::size_t>(719 - y);
        const auto depth =
            static_cast<double>(rendered.depth.metres[row * 1280 + static_cast<std::size_t>(x)]);
        EXPECT_NEAR(number(point, "distanceMetres"), depth * perDepth, depth * 0.02);
        EXPECT_LE(number(point, "nearestMetres"), number(point, "distanceMetres"));
        EXPECT_NEAR(number(point, "elevationMetres"), number(at(point, "position"), "z"), 1e-6);
        EXPECT_NEAR(number(point, "elevationErrorMetres"), number(point, "errorMetres"), 1e-6);
    }
    EXPECT_EQ(picked("640,0").output, "{}\n");
    EXPECT_EQ(picked("1280,0").exit, (test::Exit{2, 0}));
}

/// Each wall of this CAVE is two metres square, a metre from the head.
TEST_F(Render, WhatAPixelOfACavesWallShowsIsWhatACameraTurnedToItSees) {
    const JsonValue bounds = at(info("dem.eyt"), "bounds");
    const auto middle = [&](int axis) {
        return (at(bounds, "min").list_value().values(axis).number_value() +
                at(bounds, "max").list_value().values(axis).number_value()) /
               2;
    };
    const double z = at(bounds, "max").list_value().values(2).number_value() + 100;
    const auto camera = [&](const std::string& name, double east, double north) {
        return folder_->write(
            name,
            fmt::format(R"({{"eye":[{},{},{}],"target":[{},{},{}],"up":[0,0,1],"fovyDegrees":90}})",
                        middle(0), middle(1), z, middle(0) + east, middle(1) + north, z));
    };
    const std::string ahead = camera("ahead.json", 0, 1);
    const std::string cave = EYRIE_SOURCE_DIR "/../shared/data/eqc/3-channel.cave.eqc";
    const auto picked = [&](const std::string& from, const std::string& pixel,
                            const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"pick",    path("dem.eyt"), "--camera",
                                              from,      "--size",        "400x400",
                                              "--pixel", pixel,           "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::Outcome outcome = eyrie(arguments);
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        return parseJson(outcome.output);
    };
    const std::vector<std::pair<std::string, std::string>> walls = {
        {"0", camera("west.json", -1, 0)}, {"1", ahead}, {"2", camera("east.json", 1, 0)}};
    for (const auto& [segment, turned] : walls)
        for (const char* pixel : {"57,301", "200,390", "366,330"}) {
            const JsonValue wall = picked(ahead, pixel, {"--config", cave, "--segment", segment});
            const JsonValue own = picked(turned, pixel, {});
            for (const char* axis : {"x", "y", "z"})
                EXPECT_NEAR(number(at(wall, "position"), axis), number(at(own, "position"), axis),
                            1e-5)
                    << "wall " << segment << ", pixel " << pixel;
            EXPECT_GT(number(wall, "distanceMetres"), 100);
        }
    EXPECT_EQ(eyrie({"pick", path("dem.eyt"), "--camera", ahead, "--pixel", "9,9", "--config", cave,
                     "--segment", "3"})
                  .exit,
              (test::Exit{2, 0}));
}

}  // namespace
}  // namespace eyrie
