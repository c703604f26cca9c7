// SPDX-License-Identifier: Apache-2.0
// `eyrie serve` as a process with renderer processes of its own: it answers, survives the loss of a
// renderer, and leaves nothing behind.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <span>

#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/http_client.h"
#include "tests/support/json.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/viewer_client.h"
#include "wire/jpeg.h"

namespace eyrie {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kWidth = 640;
constexpr int kHeight = 360;

/// A server of the demo's scene, or of other data, in a folder of its own, as its temporary folder
/// and its cache are.
class Serve : public testing::Test {
protected:
    void start(const std::string& listen = "127.0.0.1:0",
               const std::vector<std::string>& how = {"--renderers", "2"}) {
        std::filesystem::create_directory(folder_.path("tmp"));
        std::vector<std::string> arguments{"/usr/bin/env", "-C",       folder_.path(), EYRIE_BINARY,
                                           "serve",        "--listen", listen};
        arguments.insert(arguments.end(), data_.begin(), data_.end());
        arguments.insert(arguments.end(), how.begin(), how.end());
        std::vector<std::string> environment{"TMPDIR=" + folder_.path("tmp"),
                                             "XDG_CACHE_HOME=" + folder_.path("cache")};
        environment.insert(environment.end(), environment_.begin(), environment_.end());
        server_ = std::make_unique<test::Process>(arguments, environment);
    }

    void startAndWait(const std::vector<std::string>& how = {"--renderers", "2"}) {
        start("127.0.0.1:0", how);
        ASSERT_TRUE(server_->waitForOutput("Eyrie is at http://", seconds(60)) &&
                    server_->waitForOutput("/\n", seconds(1)))
            << server_->output() << server_->errors();
        const std::string line = server_->output();
        const std::size_t port = line.find(':', line.find("http://") + 7) + 1;
        port_ = static_cast<std::uint16_t>(std::atoi(line.c_str() + port));
        ASSERT_TRUE(test::eventually(seconds(30), [&] { return aliveRenderers() == 2; }))
            << server_->errors();
    }

    /// By a configuration of two pipes, both of which one layout uses, and one the other.
    void startWithLayouts() {
        std::ofstream(folder_.path("layouts.eqc"))
            << "config { appNode { pipe { window { channel { name \"a\" } } } "
               "pipe { window { channel { name \"b\" } } } } "
               "layout { name \"both\" view { } } layout { name \"one\" view { } } "
               "canvas { layout \"both\" layout \"one\" segment { channel \"a\" } } "
               "compound { channel ( layout \"both\" view 0 ) compound { viewport [ 0 0 .5 1 ] } "
               "compound { channel \"b\" viewport [ .5 0 .5 1 ] outputframe { } } "
               "inputframe { name \"frame.b\" } } compound { channel ( layout \"one\" view 0 ) } }";
        startAndWait({"--config", folder_.path("layouts.eqc")});
    }

    void show(const std::string& layout) const {
        const auto answer =
            test::httpPatch(port_, "/api/v1/configuration",
                            R"({"layouts":[{"canvas":"0","layout":")" + layout + R"("}]})");
        ASSERT_TRUE(answer.ok() && answer->status == 200) << server_->errors();
    }

    void makeBall(int triangles, const std::string& name) const {
        const std::string source = folder_.path("ball.ply");
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", fmt::format("{}", triangles), "-o", source}));
        ASSERT_TRUE(test::succeeded({"import", "mesh", source, "-o", name}));
    }

    int httpStatus(const std::string& target) const {
        const auto answer = test::httpGet(port_, target);
        EXPECT_TRUE(answer.ok()) << answer.status();
        return answer.ok() ? answer->status : 0;
    }

    /// As /readyz tells it.
    int aliveRenderers() const {
        const auto answer = test::httpGet(port_, "/readyz");
        google::protobuf::Value state;
        if (!answer.ok() || !google::protobuf::util::JsonStringToMessage(answer->body, &state).ok())
            return -1;
        const auto& fields = state.struct_value().fields();
        const auto renderers = fields.find("renderers");
        if (renderers == fields.end())
            return -1;
        const auto& list = renderers->second.list_value().values();
        return static_cast<int>(std::count_if(list.begin(), list.end(), [](const auto& renderer) {
            const auto& facts = renderer.struct_value().fields();
            return facts.contains("alive") && facts.at("alive").bool_value();
        }));
    }

    std::vector<pid_t> rendererProcesses() const {
        std::vector<pid_t> renderers;
        for (const pid_t child : test::childrenOf(server_->id()))
            if (test::commandLineOf(child).find(" renderer ") != std::string::npos)
                renderers.push_back(child);
        return renderers;
    }

    std::unique_ptr<test::ViewerClient> connectViewer() const {
        auto viewer = test::ViewerClient::connect(port_);
        EXPECT_TRUE(viewer.ok()) << viewer.status();
        return viewer.ok() ? *std::move(viewer) : nullptr;
    }

    /// The home view of the scene, turned a little further with each call.
    v1::ViewRequest nextView(const test::ViewerClient& viewer) {
        v1::ViewRequest view;
        view.set_sequence(++sequence_);
        *view.mutable_camera() = viewer.state().home();
        const double turn = 1 + 0.002 * static_cast<double>(sequence_);
        view.mutable_camera()->set_eye(0, view.camera().eye(0) * turn);
        view.set_width(kWidth);
        view.set_height(kHeight);
        view.set_tau_pixels(1);
        return view;
    }

    /// Waits for the state that tells of a scene.
    static void awaitScene(test::ViewerClient& viewer) {
        ASSERT_TRUE(test::eventually(seconds(30), [&] {
            (void)viewer.receive(milliseconds(200));
            return viewer.state().has_home();
        })) << viewer.state().problem();
    }

    /// A picture of the asked size in which both ground and background are seen.
    static void expectPicture(const v1::Frame& frame) {
        EXPECT_EQ(frame.width(), kWidth);
        EXPECT_EQ(frame.height(), kHeight);
        EXPECT_GT(frame.statistics().triangles(), 0U);
        const auto image =
            wire::decodeJpeg(std::as_bytes(std::span(frame.jpeg().data(), frame.jpeg().size())));
        ASSERT_TRUE(image.ok()) << image.status();
        ASSERT_EQ(image->colour.size(), std::size_t{kWidth} * kHeight);
        // Each renderer draws one half: both must have things of different brightness in them.
        for (const int half : {0, kWidth / 2}) {
            int darkest = 255;
            int brightest = 0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = half; x < half + kWidth / 2; ++x) {
                    const int green = image->colour[static_cast<std::size_t>(y * kWidth + x)].g;
                    darkest = std::min(darkest, green);
                    brightest = std::max(brightest, green);
                }
            EXPECT_GT(brightest - darkest, 30) << "the half that starts at x = " << half;
        }
    }

    std::vector<std::string> data_{EYRIE_SOURCE_DIR "/demo/scene.json"};
    std::vector<std::string> environment_;
    test::TemporaryFolder folder_;
    std::unique_ptr<test::Process> server_;
    std::uint16_t port_ = 0;
    std::uint64_t sequence_ = 0;
};

TEST_F(Serve, AnswersAndEndsWithoutATraceOnATermination) {
    ASSERT_NO_FATAL_FAILURE(startAndWait());
    EXPECT_EQ(httpStatus("/healthz"), 200);
    EXPECT_EQ(httpStatus("/readyz"), 200);
    EXPECT_EQ(httpStatus("/no/such/page"), 404);
    auto viewer = connectViewer();
    ASSERT_NE(viewer, nullptr);
    ASSERT_NO_FATAL_FAILURE(awaitScene(*viewer));
    const v1::ViewRequest view = nextView(*viewer);
    auto frame = viewer->frameOf(view, seconds(20));
    while (frame.ok() && !frame->statistics().complete())
        frame = viewer->frameOf(view, seconds(20));
    ASSERT_TRUE(frame.ok()) << "frames should come until all is loaded: " << frame.status();
    EXPECT_EQ(frame->statistics().pages_missing(), 0U);
    expectPicture(*frame);

    const std::vector<pid_t> children = test::childrenOf(server_->id());
    EXPECT_EQ(rendererProcesses().size(), 2U);
    server_->send(SIGTERM);
    EXPECT_EQ(server_->waitFor(seconds(30)), (test::Exit{0, 0})) << server_->errors();
    for (const pid_t child : children)
        EXPECT_TRUE(test::eventually(seconds(10), [&] { return !test::isAlive(child); }))
            << "left behind: " << test::commandLineOf(child);
    EXPECT_EQ(test::namesIn(folder_.path("tmp")), std::set<std::string>{});
}

TEST_F(Serve, ShowsASourceWhoseNameIsNotUtf8) {
    const std::string source = folder_.path("W\xfcrfel.ply");
    ASSERT_TRUE(test::succeeded({"synth", "mesh", "--size", "200", "-o", source}));
    data_ = {source};
    ASSERT_NO_FATAL_FAILURE(startAndWait());
    EXPECT_TRUE(test::eventually(seconds(30), [&] { return httpStatus("/readyz") == 200; }));
}

TEST_F(Serve, ShowsWhatProgramsSetWhereNoDataIsNamed) {
    const std::string data = folder_.path("data");
    std::filesystem::create_directory(data);
    makeBall(1000, data + "/ball.eym");
    data_.clear();
    startAndWait({"--renderers", "auto", "--data", data});
    EXPECT_NE(server_->errors().find("no data is named"), std::string::npos) << server_->errors();
    const auto before = test::httpGet(port_, "/readyz");
    ASSERT_TRUE(before.ok());
    EXPECT_EQ(before->status, 503);
    EXPECT_NE(before->body.find("the scene is empty"), std::string::npos) << before->body;
    const auto set = test::httpPut(port_, "/api/v1/scene", R"({"objects":[{"mesh":"ball.eym"}]})");
    ASSERT_TRUE(set.ok() && set->status == 200) << server_->errors();
    EXPECT_TRUE(test::eventually(seconds(30), [&] { return httpStatus("/readyz") == 200; }));
    EXPECT_EQ(httpStatus("/api/v1/image?width=64&height=36"), 200);
}

/// EYRIE_DATA is an option of renderers, too.
TEST_F(Serve, ShowsWhatIsNamedAndNotWhatTheDataFolderHasOfThatName) {
    std::filesystem::create_directory(folder_.path("data"));
    makeBall(1000, folder_.path("data/ball.eym"));
    makeBall(2000, folder_.path("ball.eym"));
    data_ = {folder_.path("ball.eym")};
    environment_ = {"EYRIE_DATA=" + folder_.path("data")};
    startAndWait();
    ASSERT_TRUE(test::eventually(seconds(30), [&] { return httpStatus("/readyz") == 200; }));
    const auto state = test::httpGet(port_, "/readyz");
    ASSERT_TRUE(state.ok());
    EXPECT_GT(test::number(test::parseJson(state->body), "scene.triangles"), 1500) << state->body;
}

/// Programs that look into files and import them print what the server reads, whatever it prints.
TEST_F(Serve, KeepsItsOptionsFromTheProgramsThatItRuns) {
    std::filesystem::create_directory(folder_.path("data"));
    makeBall(1000, folder_.path("data/ball.eym"));
    folder_.write("data/broken.ply", "ply\n");
    folder_.write("eyrie.toml", "quiet = true\n");
    environment_ = {"EYRIE_OPTIONS=eyrie.toml", "EYRIE_QUIET=1", "EYRIE_LOG_LEVEL=off"};
    ASSERT_NO_FATAL_FAILURE(startAndWait({"--renderers", "2", "--data", folder_.path("data")}));
    const auto listed = test::httpGet(port_, "/api/v1/data-sets");
    ASSERT_TRUE(listed.ok());
    EXPECT_NE(listed->body.find("\"kind\": \"DATA_SET_KIND_MESH\""), std::string::npos)
        << listed->body;
    const auto begun =
        test::httpPost(port_, "/api/v1/imports",
                       R"({"sources":["broken.ply"],"output":"broken.eym","requestId":"broken"})");
    ASSERT_TRUE(begun.ok());
    std::string told;
    ASSERT_TRUE(test::eventually(
        seconds(30),
        [&] {
            const auto operation = test::httpGet(port_, "/api/v1/operations/broken");
            told = operation.ok() ? operation->body : "";
            return told.find("OPERATION_STATE_FAILED") != std::string::npos;
        }))
        << begun->body << told;
    EXPECT_NE(told.find("broken.ply"), std::string::npos) << told;
    EXPECT_EQ(told.find("ended with status"), std::string::npos) << told;
}

TEST_F(Serve, GoesOnWhenARendererIsKilledAndReplacesIt) {
    ASSERT_NO_FATAL_FAILURE(startAndWait());
    auto viewer = connectViewer();
    ASSERT_NE(viewer, nullptr);
    ASSERT_NO_FATAL_FAILURE(awaitScene(*viewer));
    const auto before = viewer->frameOf(nextView(*viewer), seconds(20));
    ASSERT_TRUE(before.ok()) << before.status();

    const std::vector<pid_t> renderers = rendererProcesses();
    ASSERT_EQ(renderers.size(), 2U);
    ASSERT_EQ(kill(renderers.front(), SIGKILL), 0);
    // Frames keep coming, from the first one that finds the renderer dead.
    for (int i = 0; i < 10; ++i) {
        const auto frame = viewer->frameOf(nextView(*viewer), seconds(10));
        ASSERT_TRUE(frame.ok()) << frame.status();
        expectPicture(*frame);
    }
    EXPECT_TRUE(test::eventually(
        seconds(15), [&] { return aliveRenderers() == 2 && rendererProcesses().size() == 2; }))
        << "a killed renderer should be replaced; " << server_->errors();
    EXPECT_EQ(std::ranges::count(rendererProcesses(), renderers.front()), 0);
    const auto after = viewer->frameOf(nextView(*viewer), seconds(10));
    ASSERT_TRUE(after.ok()) << after.status();
    expectPicture(*after);
}

TEST_F(Serve, StartsAndEndsRenderersAsTheLayoutsThatAreShownUseThem) {
    ASSERT_NO_FATAL_FAILURE(startWithLayouts());
    auto viewer = connectViewer();
    ASSERT_NE(viewer, nullptr);
    ASSERT_NO_FATAL_FAILURE(awaitScene(*viewer));
    // Frames keep coming until there are so many renderers, and go on with them.
    const auto expectFramesUntilThereAre = [&](std::size_t renderers) {
        ASSERT_TRUE(test::eventually(seconds(30),
                                     [&] {
                                         const auto frame =
                                             viewer->frameOf(nextView(*viewer), seconds(10));
                                         EXPECT_TRUE(frame.ok()) << frame.status();
                                         if (frame.ok())
                                             expectPicture(*frame);
                                         return rendererProcesses().size() == renderers &&
                                                aliveRenderers() == static_cast<int>(renderers);
                                     }))
            << renderers << "; " << server_->errors();
    };
    ASSERT_EQ(rendererProcesses().size(), 2U);
    ASSERT_NO_FATAL_FAILURE(show("one"));
    ASSERT_NO_FATAL_FAILURE(expectFramesUntilThereAre(1));
    ASSERT_NO_FATAL_FAILURE(show("both"));
    ASSERT_NO_FATAL_FAILURE(expectFramesUntilThereAre(2));
    EXPECT_EQ(server_->errors().find("could not draw"), std::string::npos) << server_->errors();
}

TEST_F(Serve, EndsARendererThatHangsWhenItIsToLeave) {
    ASSERT_NO_FATAL_FAILURE(startWithLayouts());
    for (const pid_t renderer : rendererProcesses()) kill(renderer, SIGSTOP);
    ASSERT_NO_FATAL_FAILURE(show("OFF"));
    EXPECT_TRUE(test::eventually(seconds(30), [&] { return rendererProcesses().size() == 1; }))
        << server_->errors();
}

TEST_F(Serve, SurvivesTheLossOfAllRenderersAtOnce) {
    ASSERT_NO_FATAL_FAILURE(startAndWait());
    auto viewer = connectViewer();
    ASSERT_NE(viewer, nullptr);
    ASSERT_NO_FATAL_FAILURE(awaitScene(*viewer));
    for (const pid_t renderer : rendererProcesses()) kill(renderer, SIGKILL);
    EXPECT_EQ(httpStatus("/healthz"), 200);
    ASSERT_TRUE(test::eventually(seconds(15), [&] { return aliveRenderers() == 2; }))
        << server_->errors();
    const auto frame = viewer->frameOf(nextView(*viewer), seconds(20));
    ASSERT_TRUE(frame.ok()) << frame.status();
    expectPicture(*frame);
}

TEST_F(Serve, RefusesAPortInUseAndSaysWhichOption) {
    ASSERT_NO_FATAL_FAILURE(startAndWait());
    const std::string address = fmt::format("127.0.0.1:{}", port_);
    const test::Outcome second =
        test::eyrie({"serve", EYRIE_SOURCE_DIR "/demo/scene.json", "--listen", address},
                    {"XDG_CACHE_HOME=" + folder_.path("cache")}, seconds(20));
    EXPECT_EQ(second.exit, (test::Exit{2, 0}));
    EXPECT_NE(second.errors.find(address), std::string::npos) << second.errors;
    EXPECT_NE(second.errors.find("--listen"), std::string::npos) << second.errors;
}

TEST_F(Serve, EndsItsRenderersWhenItIsKilledItself) {
    ASSERT_NO_FATAL_FAILURE(startAndWait());
    const std::vector<pid_t> children = test::childrenOf(server_->id());
    EXPECT_EQ(children.size(), 2U);
    kill(server_->id(), SIGKILL);
    for (const pid_t child : children)
        EXPECT_TRUE(test::eventually(seconds(15), [&] { return !test::isAlive(child); }))
            << "left behind: " << test::commandLineOf(child);
}

}  // namespace
}  // namespace eyrie
