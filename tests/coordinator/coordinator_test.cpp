// SPDX-License-Identifier: Apache-2.0
// The coordinator and its renderers over real sockets, with renderers that draw without GL.
#include "coordinator/coordinator.h"

#include <atomic>
#include <memory>
#include <thread>

#include <gmock/gmock.h>

#include "layered_scene.h"
#include "service/renderer_node.h"
#include "tests/service/eventually.h"
#include "tests/support/identifier.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::coordinator {
namespace {

class LayeredDrawer final : public service::ChannelDrawer {
public:
    explicit LayeredDrawer(std::atomic<int>& drawn) : drawn_(drawn) {}

    const fabric::DeviceInfo& device() const override { return device_; }
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene&) override {
        return fabric::SceneInfo{{{0, 0, 0}, {1, 1, 1}}, 30, 100};
    }
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData&,
                                                 const fabric::ChannelTask& task) override {
        ++drawn_;
        return LayeredScene(4711).draw(task);
    }
    service::PickFunction pickFunction() const override { return nullptr; }

private:
    std::atomic<int>& drawn_;
    const fabric::DeviceInfo device_{"Eyrie", "layers", "1.0", "none", true};
};

/// A renderer process but for the process.
class Node {
public:
    explicit Node(const std::string& coordinator) {
        service::RendererNodeOptions options;
        options.coordinator = coordinator;
        options.retryInterval = std::chrono::milliseconds(10);
        node_ = service::RendererNode::start(
                    options,
                    [this]() -> absl::StatusOr<std::unique_ptr<service::ChannelDrawer>> {
                        return std::make_unique<LayeredDrawer>(drawn_);
                    })
                    .value();
        runner_ = std::jthread(
            [this](const std::stop_token& stop) { EXPECT_TRUE(node_->run(stop).ok()); });
    }

    bool hasDrawn() const { return drawn_ > 0; }

private:
    std::atomic<int> drawn_{0};
    std::unique_ptr<service::RendererNode> node_;
    std::jthread runner_;
};

CoordinatorOptions optionsFor(const test::TemporaryFolder& folder, const std::string& layout) {
    CoordinatorOptions options;
    options.grpcAddresses = {"unix:" + folder.path("s"), "127.0.0.1:0"};
    options.layout = layout;
    options.scene.background = LayeredScene::kBackground;
    options.scene.objects.push_back(
        {"layers", fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
    return options;
}

FrameRequest request() {
    FrameRequest request;
    request.width = 41;
    request.height = 23;
    request.wantsDepth = true;
    return request;
}

class CoordinatorTest : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Of, CoordinatorTest, testing::Values("2D", "DB dynamic", "direct-send"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(CoordinatorTest, PicturesStayWholeWhileRenderersComeAndGo) {
    const test::TemporaryFolder folder;
    const auto coordinator = Coordinator::start(optionsFor(folder, GetParam())).value();
    const fabric::Image expected = LayeredScene(4711).whole(41, 23);
    const auto makesWholePictures = [&] {
        const auto frame = coordinator->frames().renderFrame(request());
        return frame.ok() && frame->image == expected;
    };
    const auto& addresses = coordinator->grpcAddresses();
    auto first = std::make_unique<Node>(addresses[0]);
    Node second(addresses[1]);
    ASSERT_TRUE(eventually([&] { return makesWholePictures() && second.hasDrawn(); }));
    first.reset();
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(makesWholePictures()) << i;
    const Node third(addresses[0]);
    ASSERT_TRUE(eventually([&] {
        EXPECT_TRUE(makesWholePictures());
        return third.hasDrawn();
    }));
}

TEST(Coordinator, TellsHowToStartARenderer) {
    const test::TemporaryFolder folder;
    const auto coordinator = Coordinator::start(optionsFor(folder, "2D")).value();
    EXPECT_THAT(coordinator->frames().status().problem,
                testing::HasSubstr("--coordinator " + coordinator->grpcAddresses()[1]));
}

TEST(Coordinator, AnInvalidSceneIsRefused) {
    const test::TemporaryFolder folder;
    CoordinatorOptions options = optionsFor(folder, "2D");
    options.scene.ambient = 7;
    EXPECT_EQ(Coordinator::start(options).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(Coordinator, NeedsAnAddress) {
    CoordinatorOptions options;
    options.grpcAddresses.clear();
    EXPECT_EQ(Coordinator::start(options).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyrie::coordinator
