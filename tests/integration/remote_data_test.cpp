// SPDX-License-Identifier: Apache-2.0
// The program on data that a real web server has.
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/nginx.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using Words = std::vector<std::string>;

std::string textOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

class RemoteData : public testing::Test {
protected:
    static void SetUpTestSuite() {
        data_ = std::make_unique<test::TemporaryFolder>();
        const auto path = [](const char* name) { return data_->path(name); };
        ASSERT_TRUE(test::succeeded(
            {"synth", "terrain", "--size", "600", "--seed", "1", "-o", path("dem.tif")}));
        ASSERT_TRUE(test::succeeded({"import", "terrain", path("dem.tif"), "-o", path("dem.eyt")}));
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", "20000", "--seed", "1", "-o", path("ball.ply")}));
        ASSERT_TRUE(test::succeeded({"import", "mesh", path("ball.ply"), "-o", path("ball.eym")}));
        nginx_ = std::make_unique<test::Nginx>(data_->path());
    }
    static void TearDownTestSuite() {
        nginx_.reset();
        data_.reset();
    }

    test::Outcome eyrie(Words arguments) const {
        arguments.insert(arguments.end(), {"--cache", folder_.path("cache")});
        return test::eyrie(arguments, {"GDAL_HTTP_CONNECTTIMEOUT=2"});
    }

    /// The picture's bytes with those of its depths.
    std::string picture(const std::string& data, const Words& options = {}) const {
        folder_.write("camera.json", camera_);
        const std::string out = folder_.path("out.png");
        const std::string depth = folder_.path("out.pfm");
        Words arguments = {"render", data,      "--camera", folder_.path("camera.json"),
                           "--size", "320x180", "--tau",    "0.5",
                           "-o",     out,       "--depth",  depth};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const test::Outcome outcome = eyrie(arguments);
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        EXPECT_EQ(outcome.errors.find("incomplete"), std::string::npos) << outcome.errors;
        EXPECT_EQ(outcome.errors.find(" 0 triangles"), std::string::npos) << outcome.errors;
        return textOf(out) + textOf(depth);
    }

    static std::string local(const std::string& name) { return data_->path(name); }
    static std::string url(const std::string& name) { return nginx_->url(name); }

    static std::unique_ptr<test::TemporaryFolder> data_;
    static std::unique_ptr<test::Nginx> nginx_;
    test::TemporaryFolder folder_;
    std::string camera_ =
        R"({"eye":[509000,5197000,6000],"target":[509000,5209000,0],"up":[0,0,1],"fovyDegrees":45})";
};

std::unique_ptr<test::TemporaryFolder> RemoteData::data_;
std::unique_ptr<test::Nginx> RemoteData::nginx_;

TEST_F(RemoteData, OfTerrainAreDrawnAsLocalOnesAndFromTheCacheWithoutAServer) {
    const std::string expected = picture(local("dem.eyt"));
    EXPECT_TRUE(picture(url("dem.eyt")) == expected);
    const std::uint64_t cold = nginx_->bytesSent();
    EXPECT_GT(cold, 10'000U);
    EXPECT_TRUE(picture(url("dem.eyt")) == expected);
    EXPECT_LT(nginx_->bytesSent() - cold, 2000U) << "the header alone";
    EXPECT_TRUE(picture(url("dem.eyt"), {"--renderers", "2", "--compound", "DB"}) == expected)
        << "renderers share the cache";
    nginx_->stop();
    EXPECT_TRUE(picture(url("dem.eyt")) == expected);
    EXPECT_TRUE(picture(url("dem.eyt"), {"--renderers", "2"}) == expected);
    nginx_->start();
}

TEST_F(RemoteData, OfAMeshAreDrawnAsLocalOnesAndFromTheCacheWithoutAServer) {
    camera_ = R"({"eye":[0,-4,1],"target":[0,0,0],"up":[0,0,1],"fovyDegrees":45})";
    const std::string expected = picture(local("ball.eym"));
    EXPECT_TRUE(picture("/vsicurl/" + url("ball.eym")) == expected);
    EXPECT_TRUE(picture(url("ball.eym"), {"--renderers", "2"}) == expected);
    nginx_->stop();
    EXPECT_TRUE(picture(url("ball.eym")) == expected);
    nginx_->start();
}

TEST_F(RemoteData, OfASceneLieAtUrlsBesideRelativePaths) {
    std::filesystem::copy_file(local("dem.eyt"), folder_.path("dem.eyt"));
    const auto scene = [&](const std::string& terrain) {
        return folder_.write("scene.json", fmt::format(R"({{"objects":[
            {{"name":"dem","terrain":"{}"}},
            {{"name":"ball","mesh":"{}"}}]}})",
                                                       terrain, url("ball.eym")));
    };
    const std::string expected = picture(scene("dem.eyt"));
    EXPECT_TRUE(picture(scene(url("dem.eyt"))) == expected);
}

TEST_F(RemoteData, AreDescribedAsLocalOnes) {
    for (const char* name : {"dem.eyt", "ball.eym"}) {
        const test::Outcome remote = eyrie({"info", url(name), "--json"});
        EXPECT_EQ(remote.exit, (test::Exit{0, 0})) << remote.errors;
        EXPECT_EQ(remote.output, eyrie({"info", local(name), "--json"}).output);
    }
}

TEST_F(RemoteData, ThatAreElevationModelsAreImportedAsLocalOnes) {
    const auto imported = [&](const std::string& dem) {
        const std::string out = folder_.path("imported.eyt");
        const test::Outcome outcome =
            test::eyrie({"import", "terrain", dem, "-o", out, "--memory", "192M"});
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        return textOf(out);
    };
    const std::string expected = imported(local("dem.tif"));
    EXPECT_TRUE(imported(url("dem.tif")) == expected) << "and known by what it holds";
    const test::Outcome none =
        test::eyrie({"import", "terrain", url("none.tif"), "-o", folder_.path("none.eyt")});
    EXPECT_EQ(none.exit, (test::Exit{2, 0}));
    EXPECT_NE(none.errors.find("none.tif: no such file, or not readable (HTTP response code: 404)"),
              std::string::npos)
        << none.errors;
    const test::Outcome other =
        test::eyrie({"import", "terrain", url("dem.eyt"), "-o", folder_.path("none.eyt")});
    EXPECT_EQ(other.exit, (test::Exit{2, 0}));
    EXPECT_NE(other.errors.find("is no raster that GDAL"), std::string::npos) << other.errors;
}

TEST_F(RemoteData, ThatAreNotThereAreRefusedByName) {
    const test::Outcome none = eyrie({"info", url("none.eyt")});
    EXPECT_EQ(none.exit, (test::Exit{2, 0}));
    EXPECT_NE(none.errors.find(url("none.eyt")), std::string::npos) << none.errors;
    EXPECT_NE(none.errors.find("404"), std::string::npos) << none.errors;
    const test::Outcome source = eyrie({"info", url("dem.tif")});
    EXPECT_EQ(source.exit, (test::Exit{2, 0})) << source.errors;
    const test::Outcome down = eyrie({"info", "http://127.0.0.1:1/dem.eyt"});
    EXPECT_EQ(down.exit, (test::Exit{1, 0}));
    EXPECT_NE(down.errors.find("http://127.0.0.1:1/dem.eyt"), std::string::npos) << down.errors;
}

TEST_F(RemoteData, AreReadByARendererOnlyFromWhereItIsAllowedTo) {
    const auto drawsFor = [&](const Words& options) {
        test::Process coordinator(
            test::eyrieCommand({"coordinator", url("dem.eyt"), "--listen", "127.0.0.1:0", "--grpc",
                                "unix:" + folder_.path("grpc"), "--cache", folder_.path("cache")}));
        EXPECT_TRUE(coordinator.waitForOutput("Renderers register", std::chrono::seconds(20)))
            << coordinator.errors();
        Words command = {"renderer",
                         "--coordinator",
                         "unix:" + folder_.path("grpc"),
                         "--listen",
                         "unix:" + folder_.path("renderer"),
                         "--cache",
                         folder_.path("cache")};
        command.insert(command.end(), options.begin(), options.end());
        const std::uint64_t before = nginx_->bytesSent();
        test::Process renderer(test::eyrieCommand(command));
        const auto refused = [&] {
            return (coordinator.errors() + renderer.errors()).find("--allow-url") !=
                   std::string::npos;
        };
        const bool ended = test::eventually(
            std::chrono::seconds(20), [&] { return refused() || nginx_->bytesSent() > before; });
        EXPECT_TRUE(ended) << coordinator.errors() << renderer.errors();
        EXPECT_NE(refused(), nginx_->bytesSent() > before);
        return !refused();
    };
    EXPECT_FALSE(drawsFor({}));
    EXPECT_FALSE(drawsFor({"--allow-url", "https://elsewhere.example/"}));
    EXPECT_TRUE(drawsFor({"--allow-url", url("")}));
}

}  // namespace
}  // namespace eyrie
