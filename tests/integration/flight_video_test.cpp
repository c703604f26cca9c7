// SPDX-License-Identifier: Apache-2.0
// `eyrie render --flight`: a video of what the program draws.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/image_files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"
#include "tests/video/decoded.h"

namespace eyrie {
namespace {

using test::eyrie;
using test::succeeded;

constexpr const char* kFirstCamera =
    R"({"eye":[-1.2,-1.6,1.1],"target":[0,0,0],"up":[0,0,1],"fovyDegrees":45})";
constexpr const char* kLastCamera =
    R"({"eye":[1.4,-1.2,0.9],"target":[0,0,0],"up":[0,0,1],"fovyDegrees":45})";

class FlightVideo : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        ASSERT_TRUE(succeeded(
            {"synth", "mesh", "--size", "20000", "--seed", "3", "-o", folder_->path("ball.ply")}));
        ASSERT_TRUE(succeeded(
            {"import", "mesh", folder_->path("ball.ply"), "-o", folder_->path("ball.eym")}));
        folder_->write("flight.json", std::string(R"({"keys":[{"seconds":0,"camera":)") +
                                          kFirstCamera + R"(},{"seconds":0.5,"camera":)" +
                                          kLastCamera + "}]}");
        folder_->write("long.json", std::string(R"({"keys":[{"seconds":0,"camera":)") +
                                        kFirstCamera + R"(},{"seconds":600,"camera":)" +
                                        kLastCamera + "}]}");
        folder_->write("last.json", kLastCamera);
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string path(const std::string& name) { return folder_->path(name); }

    /// What it says of a command line that it refuses.
    static std::string refusal(const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"render", path("ball.eym"), "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const test::Outcome outcome = eyrie(arguments);
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0})) << outcome.errors;
        return outcome.errors;
    }

    static inline std::unique_ptr<test::TemporaryFolder> folder_;
};

TEST_F(FlightVideo, ShowsWhatIsDrawnAlongIt) {
    ASSERT_TRUE(succeeded({"render", path("ball.eym"), "--flight", path("flight.json"), "--fps",
                           "20", "--size", "320x180", "-o", path("flight.mp4"), "--quiet"}));
    ASSERT_TRUE(succeeded({"render", path("ball.eym"), "--camera", path("last.json"), "--size",
                           "320x180", "-o", path("last.png"), "--quiet"}));
    const std::vector<video::Frame> frames = video::framesOfFile(path("flight.mp4"));
    ASSERT_EQ(frames.size(), 11u) << "half a second, both ends among them";
    const auto last = test::readPng(path("last.png"));
    ASSERT_TRUE(last.ok()) << last.status();
    EXPECT_GT(video::psnr(*frames.back(), *last), 32);
    EXPECT_LT(video::psnr(*frames.front(), *last), 25) << "which is another view";
}

/// By how much a picture's pixels differ in green.
double contrast(const AVFrame& frame) {
    double least = 255;
    double most = 0;
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x) {
            const double green = video::colourAt(frame, x, y)[1];
            least = std::min(least, green);
            most = std::max(most, green);
        }
    return most - least;
}

/// Where it looks without, nothing of it is left to be seen.
TEST_F(FlightVideo, OfRaisedTerrainGoesAroundItAsItIsDrawn) {
    ASSERT_TRUE(succeeded(
        {"synth", "terrain", "--size", "129", "--seed", "1", "-o", path("dem.tif"), "--quiet"}));
    ASSERT_TRUE(
        succeeded({"import", "terrain", path("dem.tif"), "-o", path("dem.eyt"), "--quiet"}));
    ASSERT_TRUE(succeeded({"render", path("dem.eyt"), "--flight", "orbit", "--fps", "1", "--size",
                           "160x90", "--exaggeration", "4", "-o", path("raised.mp4"), "--quiet"}));
    const std::vector<video::Frame> frames = video::framesOfFile(path("raised.mp4"));
    ASSERT_EQ(frames.size(), 13u);
    for (const video::Frame& frame : frames) EXPECT_GT(contrast(*frame), 40);
}

TEST_F(FlightVideo, SaysWhichPicturesAreEmptyAndWhy) {
    folder_->write("off.eqc", R"(config {
        appNode { pipe { window { viewport [ 0 0 64 64 ] channel { name "a" } } } }
        layout { name "x" view {} } canvas { layout "x" segment { channel "a" } } })");
    const test::Outcome outcome =
        eyrie({"render", path("ball.eym"), "--flight", path("flight.json"), "--fps", "4", "--size",
               "64x64", "--config", path("off.eqc"), "--layout", "OFF", "-o", path("off.mp4")});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
    EXPECT_NE(outcome.errors.find("off.mp4: 3 of 3 pictures are empty. Nothing is seen here"),
              std::string::npos)
        << outcome.errors;
}

TEST_F(FlightVideo, LeavesNothingBehindWhenStopped) {
    const test::TemporaryFolder out;
    test::Process stopped(
        test::eyrieCommand({"render", path("ball.eym"), "--flight", path("long.json"), "--size",
                            "320x180", "-o", out.path("long.mkv")}));
    ASSERT_TRUE(test::eventually(std::chrono::seconds(60),
                                 [&] { return !test::namesIn(out.path("")).empty(); }));
    stopped.send(SIGINT);
    const auto exit = stopped.waitFor(std::chrono::seconds(60));
    ASSERT_TRUE(exit);
    EXPECT_NE(*exit, (test::Exit{0, 0}));
    EXPECT_TRUE(test::namesIn(out.path("")).empty()) << stopped.errors();
}

TEST_F(FlightVideo, SaysWhatIsMissingWhereThereIsNoModule) {
    const test::TemporaryFolder elsewhere;
    std::filesystem::create_directory(elsewhere.path("bin"));
    const std::string program = elsewhere.path("bin/eyrie");
    std::filesystem::copy_file(EYRIE_BINARY, program);
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"render", path("ball.eym"), "--flight", path("flight.json"),
                                   "-o", path("none.mp4")},
          {"serve", path("ball.eym"), "--listen", "127.0.0.1:0", "--h264"},
          {"coordinator", path("ball.eym"), "--listen", "127.0.0.1:0", "--h264"}}) {
        std::vector<std::string> command = {program};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const test::Outcome outcome = test::run(command, std::chrono::seconds(60));
        EXPECT_EQ(outcome.exit, (test::Exit{1, 0})) << arguments.front();
        EXPECT_NE(outcome.errors.find("libavcodec-dev"), std::string::npos) << outcome.errors;
    }
    EXPECT_FALSE(std::filesystem::exists(path("none.mp4")));
}

TEST_F(FlightVideo, RefusesWhatItCannotWrite) {
    const auto says = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    const std::string flight = path("flight.json");
    says(refusal({"--flight", flight, "-o", path("a.png")}), ".mp4, .mkv or .webm");
    says(refusal({"--flight", flight, "-o", path("a.mp4"), "--size", "321x180"}), "even");
    says(refusal({"--flight", flight, "--camera", path("last.json"), "-o", path("a.mp4")}),
         "either --camera");
    says(refusal({"-o", path("a.mp4")}), ".png");
    says(refusal({"--flight", flight, "-o", path("a.mp4"), "--json"}), "--json");
}

}  // namespace
}  // namespace eyrie
