// SPDX-License-Identifier: Apache-2.0
// Two nodes of which each has one of a scene's two objects as a file, and reads the other's page by
// page from that node's web server into a cache of its own.
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/support/different_pixels.h"
#include "tests/support/local_pictures.h"
#include "tests/support/nginx.h"
#include "tests/support/program.h"
#include "tests/support/renderer_farm.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using coordinator::FrameRequest;
using std::chrono::seconds;

/// Has one of the files, serves it, and keeps what it reads of the other.
class Node {
public:
    explicit Node(const char* name) : name_(name) {
        std::filesystem::create_directory(folder_.path("data"));
    }

    std::string file() const { return folder_.path("data/" + name_); }
    std::string url() const { return server_->url(name_); }
    void serve() { server_ = std::make_unique<test::Nginx>(folder_.path("data")); }

    /// A renderer's options for scenes that name files as /scene/NAME.
    std::vector<std::string> wordsForPaths(const Node& partner) const {
        return wordsWith({"--data", folder_.path("data"), "--data-at",
                          fmt::format("/scene/{}={}", partner.name_, partner.url())},
                         partner);
    }
    /// The same for scenes that name each file by the URL where its node serves it.
    std::vector<std::string> wordsForUrls(const Node& partner) const {
        return wordsWith({"--data-at", fmt::format("{}={}", url(), file())}, partner);
    }

    std::uint64_t bytesKept() const {
        std::uint64_t bytes = 0;
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(folder_.path("cache")))
            bytes += entry.is_regular_file() ? entry.file_size() : 0;
        return bytes;
    }
    void forget() { std::filesystem::remove_all(folder_.path("cache")); }

private:
    std::vector<std::string> wordsWith(std::vector<std::string> words, const Node& partner) const {
        words.insert(words.end(),
                     {"--allow-url", partner.server_->url(""), "--cache", folder_.path("cache")});
        return words;
    }

    std::string name_;
    test::TemporaryFolder folder_;
    std::unique_ptr<test::Nginx> server_;
};

class DataOfTwoNodes : public testing::Test {
protected:
    static void SetUpTestSuite() {
        nodes_ = std::make_unique<Nodes>();
        const test::TemporaryFolder sources;
        const auto make = [&](const std::string& kind, const std::string& size,
                              const std::string& source, const Node& node) {
            ASSERT_TRUE(test::succeeded(
                {"synth", kind, "--size", size, "--seed", "5", "-o", sources.path(source)}));
            ASSERT_TRUE(test::succeeded({"import", kind, sources.path(source), "-o", node.file()}));
        };
        ASSERT_NO_FATAL_FAILURE(make("terrain", "1025", "dem.tif", nodes_->dem));
        ASSERT_NO_FATAL_FAILURE(make("mesh", "150000", "ball.ply", nodes_->ball));
        nodes_->dem.serve();
        nodes_->ball.serve();
    }
    static void TearDownTestSuite() { nodes_.reset(); }

    /// A ball above a terrain.
    static fabric::Scene scene(const std::string& terrain, const std::string& mesh) {
        fabric::Scene scene;
        scene.objects.push_back(
            {.name = "dem", .kind = fabric::ObjectKind::Terrain, .path = terrain});
        const fabric::Mat4 place =
            glm::translate(fabric::Mat4(1), fabric::Vec3(517'000, 5'215'000, 3000));
        scene.objects.push_back({.name = "ball",
                                 .path = mesh,
                                 .worldFromObject = glm::scale(place, fabric::Vec3(3000))});
        return scene;
    }

    /// Of the ball and the land before it, which is a part of all.
    static FrameRequest view() {
        FrameRequest view;
        view.camera.eye = {516'000, 5'203'000, 6000};
        view.camera.target = {516'500, 5'215'000, 2000};
        view.width = 640;
        view.height = 360;
        view.wantsDepth = true;
        return view;
    }

    /// By one renderer that has both files.
    static fabric::Image expected() {
        const auto here = test::LocalPictures::open(scene(nodes_->dem.file(), nodes_->ball.file()));
        EXPECT_TRUE(here.ok()) << here.status();
        fabric::ChannelTask task;
        task.pixelViewport = {0, 0, view().width, view().height};
        task.wantsDepth = true;
        const auto picture = (*here)->draw(view(), task);
        EXPECT_TRUE(picture.ok()) << picture.status();
        return *picture;
    }

    static void expectDrawn(test::RendererFarm& farm, const fabric::Image& expected) {
        const auto frame = farm.frames().renderFrame(view());
        ASSERT_TRUE(frame.ok()) << frame.status();
        EXPECT_TRUE(frame->statistics.complete);
        EXPECT_EQ(test::differentPixels(frame->image, expected), 0U);
    }

    static void expectKeepsLess(const Node& node, const Node& partner) {
        const std::uint64_t all = std::filesystem::file_size(partner.file());
        const std::uint64_t kept = node.bytesKept();
        EXPECT_GT(kept, 0U);
        EXPECT_LT(kept, all) << "not only what is seen came over";
        fmt::print("{} of the {} bytes of {} came over\n", kept, all, partner.file());
    }

    /// Of two renderers in `layout`, with options of their own, then of one, when the other has
    /// been killed.
    static void expectDrawnBy(const std::string& layout, const fabric::Scene& scene,
                              const std::vector<std::vector<std::string>>& words,
                              std::size_t killed) {
        SCOPED_TRACE(layout);
        const fabric::Image picture = expected();
        nodes_->dem.forget();
        nodes_->ball.forget();
        const auto farm =
            test::RendererFarm::start(EYRIE_BINARY, 2, {.layout = layout, .scene = scene}, words);
        ASSERT_TRUE(farm.ok()) << farm.status();
        ASSERT_TRUE((*farm)->awaitAllReady(seconds(30)))
            << (*farm)->frames().status().problem << (*farm)->renderer(0).errors();
        ASSERT_NO_FATAL_FAILURE(expectDrawn(**farm, picture));
        expectKeepsLess(nodes_->dem, nodes_->ball);
        expectKeepsLess(nodes_->ball, nodes_->dem);
        (*farm)->renderer(killed).send(SIGKILL);
        expectDrawn(**farm, picture);
    }

    struct Nodes {
        Node dem{"dem.eyt"};
        Node ball{"ball.eym"};
    };
    static std::unique_ptr<Nodes> nodes_;
};
std::unique_ptr<DataOfTwoNodes::Nodes> DataOfTwoNodes::nodes_;

TEST_F(DataOfTwoNodes, AreDrawnAsOfOneThatHasAllAndComePageByPage) {
    expectDrawnBy(
        "2D", scene("/scene/dem.eyt", "/scene/ball.eym"),
        {nodes_->dem.wordsForPaths(nodes_->ball), nodes_->ball.wordsForPaths(nodes_->dem)}, 0);
}

TEST_F(DataOfTwoNodes, AreFoundAtHomeWhereScenesNameTheirUrls) {
    expectDrawnBy("DB static", scene(nodes_->dem.url(), nodes_->ball.url()),
                  {nodes_->dem.wordsForUrls(nodes_->ball), nodes_->ball.wordsForUrls(nodes_->dem)},
                  1);
}

}  // namespace
}  // namespace eyrie
