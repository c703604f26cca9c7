// SPDX-License-Identifier: Apache-2.0
// The coordinator and its renderers over real sockets, with renderers that draw without GL.
#include "coordinator/coordinator.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <set>
#include <thread>

#include <gmock/gmock.h>

#include "layered_scene.h"
#include "service/renderer_node.h"
#include "tests/service/eventually.h"
#include "tests/support/identifier.h"
#include "tests/support/json.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/told_services.h"

namespace eyrie::coordinator {
namespace {

class LayeredDrawer final : public service::ChannelDrawer {
public:
    LayeredDrawer(std::atomic<int>& drawn, std::atomic<bool>& hangs)
        : drawn_(drawn), hangs_(hangs) {}

    const fabric::DeviceInfo& device() const override { return device_; }
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene&) override {
        return fabric::SceneInfo{{{0, 0, 0}, {1, 1, 1}}, 30, 100};
    }
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData&,
                                                 const fabric::ChannelTask& task,
                                                 const fabric::Delivery&) override {
        ++drawn_;
        hangs_.wait(true);
        return LayeredScene(4711).draw(task);
    }
    service::PickFunction pickFunction() const override { return nullptr; }

private:
    std::atomic<int>& drawn_;
    std::atomic<bool>& hangs_;
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
                        return std::make_unique<LayeredDrawer>(drawn_, hangs_);
                    })
                    .value();
        runner_ = std::jthread(
            [this](const std::stop_token& stop) { EXPECT_TRUE(node_->run(stop).ok()); });
    }

    bool hasDrawn() const { return drawn_ > 0; }
    int drawn() const { return drawn_; }

    /// From its next channel on, or no longer.
    void hang(bool hangs) {
        hangs_ = hangs;
        hangs_.notify_all();
    }

private:
    std::atomic<int> drawn_{0};
    std::atomic<bool> hangs_{false};
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

/// A span of the trace, in microseconds.
struct Traced {
    std::string process;
    std::string thread;
    std::string name;
    double frame;
    double begin;
    double end;
};

std::vector<Traced> tracedBy(const Coordinator& coordinator) {
    const std::vector<test::JsonValue> events = test::list(
        test::parseJson(coordinator.telemetry()->traces.chromeJson(1000)), "traceEvents");
    std::map<double, std::string> names;
    for (const test::JsonValue& event : events)
        if (test::at(event, "ph").string_value() == "M") {
            const bool isProcess = test::at(event, "name").string_value() == "process_name";
            names[isProcess ? test::number(event, "pid") : -test::number(event, "tid")] =
                test::at(event, "args.name").string_value();
        }
    std::vector<Traced> spans;
    for (const test::JsonValue& event : events)
        if (test::at(event, "ph").string_value() == "X")
            spans.push_back(
                {names.at(test::number(event, "pid")), names.at(-test::number(event, "tid")),
                 test::at(event, "name").string_value(),
                 test::at(event, "args.frame").number_value(), test::number(event, "ts"),
                 test::number(event, "ts") + test::number(event, "dur")});
    return spans;
}

TEST(Coordinator, TracesShowWhatEachRendererDidWithinTheCallThatAskedForIt) {
    const test::TemporaryFolder folder;
    const auto coordinator = Coordinator::start(optionsFor(folder, "2D")).value();
    const Node first(coordinator->grpcAddresses()[0]);
    const Node second(coordinator->grpcAddresses()[1]);
    ASSERT_TRUE(eventually([&] {
        return coordinator->frames().renderFrame(request()).ok() && first.drawn() > 2 &&
               second.drawn() > 2;
    }));
    const std::vector<Traced> spans = tracedBy(*coordinator);
    std::set<std::string> drawing;
    for (const Traced& one : spans) {
        EXPECT_GE(one.begin, 0);
        EXPECT_LE(one.begin, one.end);
        // What shares a thread is beside or within, to the nanosecond that it is told in.
        constexpr double kRounding = 1e-3;
        for (const Traced& other : spans) {
            const bool isWhileIt = one.process == other.process && one.thread == other.thread &&
                                   one.begin < other.begin - kRounding &&
                                   other.begin < one.end - kRounding;
            EXPECT_TRUE(!isWhileIt || other.end <= one.end + kRounding)
                << one.name << " and " << other.name;
        }
        if (one.process == "coordinator" || one.name != "channel")
            continue;
        drawing.insert(one.process);
        EXPECT_TRUE(std::ranges::any_of(spans,
                                        [&](const Traced& call) {
                                            return call.process == "coordinator" &&
                                                   call.thread == "asks " + one.process &&
                                                   call.frame == one.frame &&
                                                   call.begin <= one.begin + kRounding &&
                                                   one.end <= call.end + kRounding;
                                        }))
            << one.process << " drew for frame " << one.frame;
    }
    EXPECT_EQ(drawing.size(), 2u);
    for (const char* stage : {"frame", "plan", "render", "compose", "receive", "cull", "queue"})
        EXPECT_TRUE(std::ranges::any_of(spans, [&](const Traced& span) {
            return span.name == stage;
        })) << stage;
}

TEST(Coordinator, AbandonsFramesWhateverRenderersDo) {
    const test::TemporaryFolder folder;
    const auto coordinator = Coordinator::start(optionsFor(folder, "2D")).value();
    Node node(coordinator->grpcAddresses()[0]);
    ASSERT_TRUE(eventually([&] { return coordinator->frames().renderFrame(request()).ok(); }));
    node.hang(true);
    const int before = node.drawn();
    std::jthread abandoning([&] {
        EXPECT_TRUE(eventually([&] { return node.drawn() > before; }));
        coordinator->abandonFrames();
    });
    EXPECT_FALSE(coordinator->frames().renderFrame(request()).ok());
    EXPECT_FALSE(coordinator->frames().renderFrame(request()).ok());
    node.hang(false);
}

TEST(Coordinator, TellsHowToStartARenderer) {
    const test::TemporaryFolder folder;
    const auto coordinator = Coordinator::start(optionsFor(folder, "2D")).value();
    EXPECT_THAT(coordinator->frames().status().problem,
                testing::HasSubstr("--coordinator " + coordinator->grpcAddresses()[1]));
}

TEST(Coordinator, TellsToolsItsCallsOnlyWhereItIsToDoSo) {
    const test::TemporaryFolder folder;
    CoordinatorOptions options = optionsFor(folder, "2D");
    {
        const auto silent = Coordinator::start(options).value();
        EXPECT_EQ(test::servicesToldAt(silent->grpcAddresses()[0]).first,
                  grpc::StatusCode::UNIMPLEMENTED);
    }
    options.grpcReflection = true;
    const auto coordinator = Coordinator::start(options).value();
    const auto [code, told] = test::servicesToldAt(coordinator->grpcAddresses()[0]);
    EXPECT_EQ(code, grpc::StatusCode::OK);
    EXPECT_THAT(told, testing::HasSubstr("eyrie.v1.CoordinatorService"));
}

TEST(Coordinator, AnInvalidSceneIsRefused) {
    const test::TemporaryFolder folder;
    CoordinatorOptions options = optionsFor(folder, "2D");
    options.scene.ambient = 7;
    EXPECT_EQ(Coordinator::start(options).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(Coordinator, ASceneThatMessagesCannotNameIsRefused) {
    const test::TemporaryFolder folder;
    CoordinatorOptions options = optionsFor(folder, "2D");
    const auto coordinator = Coordinator::start(options).value();
    options.scene.objects.front().path = "/data/\xfc.eyt";
    options.grpcAddresses = {"unix:" + folder.path("other")};
    const absl::Status status = Coordinator::start(options).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message(), "/data/\\xfc.eyt is not UTF-8; rename the file");
    EXPECT_EQ(coordinator->setScene(options.scene), status);
}

TEST(Coordinator, NeedsAnAddress) {
    CoordinatorOptions options;
    options.grpcAddresses.clear();
    EXPECT_EQ(Coordinator::start(options).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyrie::coordinator
