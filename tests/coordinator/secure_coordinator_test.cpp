// SPDX-License-Identifier: Apache-2.0
// Who is let in between coordinator and renderers, over real sockets.
#include <atomic>
#include <filesystem>
#include <memory>
#include <thread>

#include <gmock/gmock.h>

#include "coordinator/coordinator.h"
#include "coordinator/farm/grpc_renderer.h"
#include "layered_scene.h"
#include "service/peers.h"
#include "service/registration.h"
#include "service/renderer_node.h"
#include "tests/service/eventually.h"
#include "tests/support/certificates.h"
#include "tests/support/identifier.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr char kAdmin[] = "admin-0123456789abcdef0123456789";
constexpr char kView[] = "view-0123456789abcdef0123456789";

class LayeredDrawer final : public service::ChannelDrawer {
public:
    explicit LayeredDrawer(std::atomic<int>& drawn) : drawn_(drawn) {}

    const fabric::DeviceInfo& device() const override { return device_; }
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene&) override {
        return fabric::SceneInfo{{{0, 0, 0}, {1, 1, 1}}, 30, 100};
    }
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData&,
                                                 const fabric::ChannelTask& task,
                                                 const fabric::Delivery&) override {
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
    Node(const std::string& coordinator, const wire::Security& security) {
        service::RendererNodeOptions options;
        options.coordinator = coordinator;
        options.retryInterval = milliseconds(20);
        options.security = security;
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
    const std::string& address() const { return node_->address(); }

private:
    std::atomic<int> drawn_{0};
    std::unique_ptr<service::RendererNode> node_;
    std::jthread runner_;
};

wire::Security withTokens(const std::string& token = kAdmin) {
    wire::Security security;
    security.gate = std::make_shared<access::Gate>(
        *access::Tokens::parse(fmt::format("admin {}\nview {}\n", kAdmin, kView), "t"));
    security.token = [token] { return token; };
    return security;
}

/// Those of a file, and the one that it has for admins is shown.
wire::Security withTokensOf(const std::string& file) {
    wire::Security security;
    security.gate = std::make_shared<access::Gate>(access::TokenFile::open(file).value());
    security.token = [gate = security.gate] { return gate->tokenOf(access::Role::Admin); };
    return security;
}

wire::Security withCertificate(const access::TlsFiles& files) {
    wire::Security security;
    security.tls = files;
    return security;
}

std::unique_ptr<Coordinator> coordinatorWith(const wire::Security& security,
                                             const std::string& layout = "2D") {
    CoordinatorOptions options;
    options.security = security;
    options.layout = layout;
    options.scene.background = LayeredScene::kBackground;
    options.scene.objects.push_back(
        {"layers", fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
    return Coordinator::start(options).value();
}

FrameRequest request() {
    FrameRequest request;
    request.width = 41;
    request.height = 23;
    request.wantsDepth = true;
    return request;
}

bool makesWholePictures(Coordinator& coordinator) {
    const auto frame = coordinator.frames().renderFrame(request());
    return frame.ok() && frame->image == LayeredScene(4711).whole(41, 23);
}

/// How a renderer that shows itself so fares with the coordinator: OK when it gets in.
absl::Status registering(Coordinator& coordinator, const wire::Security& security,
                         milliseconds patience = milliseconds(1500)) {
    service::RegistrationOptions options;
    options.coordinator = coordinator.grpcAddresses().front();
    static std::atomic<int> port{10};  // of nobody, and of no other call
    options.address = fmt::format("127.0.0.1:{}", port++);
    options.security = security;
    options.retryInterval = milliseconds(20);
    options.giveUpAfter = patience;
    options.drainTime = seconds(1);
    std::stop_source stop;
    std::jthread stopper([&](const std::stop_token& done) {
        while (!done.stop_requested()) {
            for (const auto& renderer : coordinator.frames().status().renderers)
                if (renderer.address == options.address && renderer.isAlive())
                    stop.request_stop();
            std::this_thread::sleep_for(milliseconds(5));
        }
    });
    return service::keepRegistered(options, stop.get_token());
}

class SecureCoordinator : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Of, SecureCoordinator, testing::Values("2D", "direct-send"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(SecureCoordinator, MakesPicturesWithRenderersThatShowCertificatesAndTokens) {
    const test::Authority authority("the authority");
    wire::Security ofCoordinator = withTokens();
    ofCoordinator.tls = authority.issue("coordinator");
    wire::Security ofNode = withTokens();
    ofNode.tls = authority.issue("node");
    const auto coordinator = coordinatorWith(ofCoordinator, GetParam());
    const Node first(coordinator->grpcAddresses().front(), ofNode);
    const Node second(coordinator->grpcAddresses().front(), ofNode);
    EXPECT_TRUE(eventually(
        [&] { return makesWholePictures(*coordinator) && first.hasDrawn() && second.hasDrawn(); }));
}

TEST(GrpcTokens, AreAskedForByTheCoordinator) {
    const wire::Security security = withTokens();
    const auto coordinator = coordinatorWith(security);
    EXPECT_TRUE(registering(*coordinator, withTokens()).ok());
    EXPECT_TRUE(absl::IsUnauthenticated(registering(*coordinator, {})));
    EXPECT_TRUE(absl::IsUnauthenticated(
        registering(*coordinator, withTokens("wrong-0123456789abcdef0123456789"))));
    EXPECT_TRUE(absl::IsPermissionDenied(registering(*coordinator, withTokens(kView))));
    EXPECT_EQ(security.gate->refusals(access::Door::Grpc), (access::Refusals{1, 1, 0, 1}));
}

TEST(GrpcTokens, MayBeReplacedInTheFileWhilePicturesAreMade) {
    constexpr char kOther[] = "other-0123456789abcdef0123456789";
    const test::TemporaryFolder folder;
    const auto replaceBy = [&folder](const std::string& token) {
        const std::string fresh = folder.write("fresh", "admin " + token + "\n");
        std::filesystem::permissions(fresh, std::filesystem::perms::owner_read);
        std::filesystem::rename(fresh, folder.path("tokens"));
        return folder.path("tokens");
    };
    const std::string file = replaceBy(kAdmin);
    const auto coordinator = coordinatorWith(withTokensOf(file));
    const Node node(coordinator->grpcAddresses().front(), withTokensOf(file));
    EXPECT_TRUE(eventually([&] { return makesWholePictures(*coordinator); }));

    replaceBy(kOther);
    EXPECT_TRUE(registering(*coordinator, withTokens(kOther)).ok());
    EXPECT_TRUE(absl::IsUnauthenticated(registering(*coordinator, withTokens(kAdmin))));
    EXPECT_TRUE(eventually([&] { return makesWholePictures(*coordinator); }));
}

TEST(GrpcTokens, AreAskedForByEveryCallOfARenderer) {
    const auto coordinator = coordinatorWith(withTokens());
    const Node node(coordinator->grpcAddresses().front(), withTokens());
    const auto soon = [] { return ChannelRenderer::Clock::now() + seconds(20); };
    for (const auto& [security, code] :
         {std::pair(wire::Security(), absl::StatusCode::kUnauthenticated),
          std::pair(withTokens("wrong-0123456789abcdef0123456789"),
                    absl::StatusCode::kUnauthenticated),
          std::pair(withTokens(kView), absl::StatusCode::kPermissionDenied)}) {
        const auto renderer = connectRenderer(node.address(), security);
        EXPECT_EQ(renderer->openScene({}, soon()).status().code(), code);
        EXPECT_EQ(renderer->setFrameData({}, soon()).code(), code);
        EXPECT_EQ(renderer->render({}, soon()).status().code(), code);
        EXPECT_EQ(renderer->runProgram({}, soon(), {}).status().code(), code);
        EXPECT_EQ(renderer->pick({}, soon()).status().code(), code);
        service::Peers peers(security);
        const fabric::Image image = fabric::makeImage({0, 0, 8, 8}, {}, true);
        EXPECT_EQ(peers.send(node.address(), {}, image, soon(), {}).code(), code);
    }
}

TEST(GrpcTls, RefusesRenderersWithoutAValidCertificateOfTheAuthority) {
    const test::Authority authority("the authority");
    const test::Authority other("another authority");
    const auto coordinator = coordinatorWith(withCertificate(authority.issue("coordinator")));
    EXPECT_TRUE(
        registering(*coordinator, withCertificate(authority.issue("node")), seconds(30)).ok());
    EXPECT_TRUE(absl::IsUnavailable(registering(*coordinator, {}))) << "in the clear";
    access::TlsFiles foreign = other.issue("node");
    EXPECT_TRUE(absl::IsUnavailable(registering(*coordinator, withCertificate(foreign))));
    foreign.authority = authority.file();
    EXPECT_TRUE(absl::IsUnavailable(registering(*coordinator, withCertificate(foreign))))
        << "it believes the coordinator, which does not believe it";
    EXPECT_TRUE(absl::IsUnavailable(registering(
        *coordinator, withCertificate(authority.issue("old", {.validToSeconds = -1800})))));
}

TEST(GrpcTls, RenderersRefuseACoordinatorOfAnotherNameUnlessItIsExpected) {
    const test::Authority authority("the authority");
    const auto coordinator =
        coordinatorWith(withCertificate(authority.issue("coordinator", {.name = "eyrie.example"})));
    wire::Security node = withCertificate(authority.issue("node"));
    EXPECT_TRUE(absl::IsUnavailable(registering(*coordinator, node)));
    node.peerName = "eyrie.example";
    EXPECT_TRUE(registering(*coordinator, node, seconds(30)).ok());
}

TEST(GrpcTls, TakesReplacedCertificatesWhileConnectionsGoOn) {
    const test::Authority authority("the authority");
    const auto coordinator = coordinatorWith(withCertificate(authority.issue("coordinator")));
    const wire::Security security = withCertificate(authority.issue("node"));
    const Node node(coordinator->grpcAddresses().front(), security);
    ASSERT_TRUE(eventually([&] { return makesWholePictures(*coordinator); }));
    // For another host, so that it shows which one new connections get.
    authority.issue("coordinator", {.name = "elsewhere.example"});
    EXPECT_TRUE(eventually([&] {
        return absl::IsUnavailable(registering(*coordinator, security, milliseconds(300)));
    })) << "the new certificate is not taken";
    const auto makesPictures = [&] { return makesWholePictures(*coordinator); };
    // Longer than a renderer lives whose heartbeats do not come: it could not connect again.
    const auto end = std::chrono::steady_clock::now() + seconds(4);
    while (std::chrono::steady_clock::now() < end) ASSERT_TRUE(eventually(makesPictures));
    authority.issue("coordinator");
    EXPECT_TRUE(registering(*coordinator, security, seconds(30)).ok());
    EXPECT_TRUE(eventually(makesPictures));
}

}  // namespace
}  // namespace eyrie::coordinator
