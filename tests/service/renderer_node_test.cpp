// SPDX-License-Identifier: Apache-2.0
#include "service/renderer_node.h"

#include <atomic>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>

#include "coordinator/api/grpc_service.h"
#include "coordinator/farm/registry.h"
#include "eyrie/v1/registry_service.grpc.pb.h"
#include "fabric/version.h"
#include "fake_drawer.h"
#include "tests/service/eventually.h"
#include "tests/support/temporary_folder.h"
#include "wire/listen.h"
#include "wire/protocol.h"
#include "wire/transport.h"

namespace eyrie::service {
namespace {

using coordinator::GrpcService;
using coordinator::Registry;

coordinator::RegistryOptions quickHeartbeats() {
    coordinator::RegistryOptions options;
    options.heartbeatInterval = std::chrono::milliseconds(10);
    return options;
}

int aliveIn(const Registry& registry) {
    int alive = 0;
    for (const Registry::Entry& entry : registry.entries()) alive += entry.isAlive() ? 1 : 0;
    return alive;
}

/// A coordinator that counts what it hears.
class CountingCoordinator final : public v1::RegistryService::Service {
public:
    grpc::Status RegisterRenderer(grpc::ServerContext*, const v1::RegisterRendererRequest*,
                                  v1::RegisterRendererResponse* response) override {
        ++registrations;
        response->set_renderer_id("r7");
        response->set_heartbeat_milliseconds(10);
        return grpc::Status::OK;
    }
    grpc::Status Heartbeat(grpc::ServerContext*, const v1::HeartbeatRequest* request,
                           v1::HeartbeatResponse*) override {
        heartbeats += request->renderer_id() == "r7" ? 1 : 0;
        if (unheard > 0 && request->refused().wrong_token() > 0) {
            --unheard;
            return {grpc::StatusCode::UNAVAILABLE, "not heard"};
        }
        wrongTokens += request->refused().wrong_token();
        noTokens += request->refused().no_token();
        return grpc::Status::OK;
    }

    std::atomic<int> registrations{0};
    std::atomic<int> heartbeats{0};
    std::atomic<int> unheard{0};  ///< heartbeats with wrong tokens that fail
    std::atomic<std::uint32_t> wrongTokens{0};
    std::atomic<std::uint32_t> noTokens{0};
};

class RendererNodeTest : public testing::Test {
protected:
    void startCoordinator() {
        registry_ = std::make_unique<Registry>(quickHeartbeats());
        registry_->listeners().add([registry = registry_.get(), this] {
            for (const Registry::Entry& entry : registry->entries())
                if (entry.presence == Registry::Presence::Draining && !isBusy_)
                    registry->remove(entry.id);
        });
        door_ = GrpcService::start({"unix:" + folder_.path("s")}, *registry_).value();
    }
    void stopCoordinator() {
        door_.reset();
        registry_.reset();
    }
    void startNode(bool exitWithCoordinator = false, const wire::Security& security = {}) {
        RendererNodeOptions options;
        options.security = security;
        options.coordinator = "unix:" + folder_.path("s");
        options.node = "left";
        options.exitWithCoordinator = exitWithCoordinator;
        options.giveUpAfter = std::chrono::milliseconds(200);
        options.retryInterval = std::chrono::milliseconds(10);
        node_ = RendererNode::start(options, fakeDrawers(control_)).value();
        runner_ = std::jthread([this](const std::stop_token& stop) {
            result_ = node_->run(stop);
            ended_ = true;
        });
    }
    bool registers() {
        return eventually([this] { return aliveIn(*registry_) == 1; });
    }

    test::TemporaryFolder folder_;
    std::shared_ptr<FakeDrawerControl> control_ = std::make_shared<FakeDrawerControl>();
    std::atomic<bool> isBusy_{false};  ///< in the eyes of the coordinator
    std::unique_ptr<Registry> registry_;
    std::unique_ptr<GrpcService> door_;
    std::unique_ptr<RendererNode> node_;
    absl::Status result_;
    std::atomic<bool> ended_{false};
    std::jthread runner_;
};

TEST_F(RendererNodeTest, RegistersWithItsDeviceAddressAndNode) {
    startCoordinator();
    startNode();
    ASSERT_TRUE(registers());
    const Registry::Entry entry = registry_->entries()[0];
    EXPECT_EQ(entry.device, node_->device());
    EXPECT_EQ(entry.address, node_->address());
    EXPECT_EQ(entry.node, "left");
    EXPECT_TRUE(
        entry.renderer->openScene({}, Registry::Clock::now() + std::chrono::seconds(20)).ok());
}

TEST_F(RendererNodeTest, WaitsForACoordinatorThatComesLater) {
    startNode();
    startCoordinator();
    EXPECT_TRUE(registers());
}

TEST_F(RendererNodeTest, RegistersOnceAndThenSendsHeartbeats) {
    CountingCoordinator service;
    const auto listening = wire::listen({"unix:" + folder_.path("s")}, service).value();
    startNode();
    EXPECT_TRUE(eventually([&] { return service.heartbeats >= 5; }));
    EXPECT_EQ(service.registrations, 1);
    runner_.request_stop();
    runner_.join();
}

TEST_F(RendererNodeTest, TellsTheCoordinatorOnceOfEachThatItTurnedAway) {
    CountingCoordinator service;
    service.unheard = 2;
    const auto listening = wire::listen({"unix:" + folder_.path("s")}, service).value();
    wire::Security security;
    security.gate = std::make_shared<access::Gate>(
        *access::Tokens::parse("admin admin-0123456789abcdef0123456789\n", "t"));
    const auto comesWith = [&](const char* authorization) {
        return security.gate->admit({authorization, {}, access::Door::Grpc}, "10.0.0.1",
                                    access::Role::Admin);
    };
    EXPECT_FALSE(comesWith("").ok());  // before it has registered
    startNode(false, security);
    EXPECT_TRUE(eventually([&] { return service.noTokens == 1; }));
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(comesWith("Bearer wrong").ok());
    EXPECT_TRUE(eventually([&] { return service.wrongTokens == 3; })) << service.wrongTokens;
    const int heartbeats = service.heartbeats;
    EXPECT_TRUE(eventually([&] { return service.heartbeats >= heartbeats + 5; }));
    EXPECT_EQ(service.unheard, 0);
    EXPECT_EQ(service.wrongTokens, 3U);
    EXPECT_EQ(service.noTokens, 1U);
    runner_.request_stop();
    runner_.join();
}

TEST_F(RendererNodeTest, RegistersAgainWhenItWasGivenUp) {
    startCoordinator();
    startNode();
    ASSERT_TRUE(registers());
    const std::string before = registry_->entries()[0].id;
    registry_->markDead(before, "test", Registry::Clock::now());
    ASSERT_TRUE(registers());
    ASSERT_EQ(registry_->entries().size(), 1U);
    EXPECT_NE(registry_->entries()[0].id, before);
}

TEST_F(RendererNodeTest, RegistersAgainWithACoordinatorThatRestarted) {
    startCoordinator();
    startNode();
    ASSERT_TRUE(registers());
    stopCoordinator();
    startCoordinator();
    EXPECT_TRUE(registers());
    EXPECT_FALSE(ended_);
}

TEST_F(RendererNodeTest, EndsWithItsCoordinatorWhenToldTo) {
    startCoordinator();
    startNode(true);
    ASSERT_TRUE(registers());
    stopCoordinator();
    ASSERT_TRUE(eventually([this] { return ended_.load(); }));
    EXPECT_EQ(result_.code(), absl::StatusCode::kUnavailable);
    EXPECT_THAT(std::string(result_.message()), testing::HasSubstr("unix:" + folder_.path("s")));
}

TEST_F(RendererNodeTest, EndsWhenItIsStopped) {
    startCoordinator();
    startNode();
    ASSERT_TRUE(registers());
    runner_.request_stop();
    ASSERT_TRUE(eventually([this] { return ended_.load(); }));
    EXPECT_TRUE(result_.ok()) << result_;
    runner_.join();
    node_.reset();
    EXPECT_TRUE(control_->destroyed);
}

TEST_F(RendererNodeTest, StaysUntilTheCoordinatorHasNothingMoreForIt) {
    startCoordinator();
    startNode();
    ASSERT_TRUE(registers());
    isBusy_ = true;
    runner_.request_stop();
    const auto drains = [&] {
        const auto entries = registry_->entries();
        return !entries.empty() && entries[0].presence == Registry::Presence::Draining;
    };
    ASSERT_TRUE(eventually(drains));
    const Registry::Entry entry = registry_->entries()[0];
    EXPECT_TRUE(
        entry.renderer->openScene({}, Registry::Clock::now() + std::chrono::seconds(20)).ok());
    EXPECT_FALSE(ended_);
    registry_->remove(entry.id);
    ASSERT_TRUE(eventually([this] { return ended_.load(); }));
    EXPECT_TRUE(result_.ok()) << result_;
}

TEST(RendererNode, AnAddressOfAnotherFormIsRefused) {
    RendererNodeOptions options;
    options.coordinator = "nowhere";
    const auto node =
        RendererNode::start(options, fakeDrawers(std::make_shared<FakeDrawerControl>()));
    EXPECT_EQ(node.status().code(), absl::StatusCode::kInvalidArgument);
}

std::unique_ptr<v1::RegistryService::Stub> registryAt(const std::string& address) {
    return v1::RegistryService::NewStub(grpc::CreateCustomChannel(
        address, grpc::InsecureChannelCredentials(), wire::clientArguments()));
}

/// A coordinator's door.
struct Door {
    explicit Door(const std::string& address)
        : service(GrpcService::start({address}, registry).value()), stub(registryAt(address)) {}

    /// The id that a renderer at `address` is given.
    std::string registered(const std::string& address) const {
        v1::RegisterRendererRequest request;
        request.set_address(address);
        request.set_software_version(std::string(fabric::kVersion));
        request.set_protocol_checksum(wire::protocolChecksum());
        v1::RegisterRendererResponse response;
        grpc::ClientContext context;
        EXPECT_TRUE(stub->RegisterRenderer(&context, request, &response).ok());
        return response.renderer_id();
    }
    grpc::StatusCode heartbeat(const std::string& id) const {
        v1::HeartbeatRequest request;
        request.set_renderer_id(id);
        v1::HeartbeatResponse response;
        grpc::ClientContext context;
        return stub->Heartbeat(&context, request, &response).error_code();
    }
    grpc::StatusCode drain(const std::string& id) const {
        v1::DrainRequest request;
        request.set_renderer_id(id);
        v1::DrainResponse response;
        grpc::ClientContext context;
        return stub->Drain(&context, request, &response).error_code();
    }

    Registry registry;
    const std::unique_ptr<GrpcService> service;
    const std::unique_ptr<v1::RegistryService::Stub> stub;
};

TEST(CoordinatorGrpc, AnIdOfTheCoordinatorBeforeIsNobodysOfTheNext) {
    const test::TemporaryFolder folder;
    const std::string address = "unix:" + folder.path("s");
    std::string before;
    {
        const Door door(address);
        before = door.registered("127.0.0.1:1");
        EXPECT_EQ(door.heartbeat(before), grpc::StatusCode::OK);
    }
    const Door door(address);
    const std::string other = door.registered("127.0.0.1:2");
    EXPECT_EQ(door.heartbeat(before), grpc::StatusCode::NOT_FOUND);
    EXPECT_EQ(door.drain(before), grpc::StatusCode::NOT_FOUND);
    ASSERT_EQ(door.registry.entries().size(), 1U);
    EXPECT_EQ(door.registry.entries()[0].id, "renderer-1") << "as people see it";
    EXPECT_EQ(door.registry.entries()[0].presence, Registry::Presence::Alive);
    EXPECT_EQ(door.heartbeat(other), grpc::StatusCode::OK);
    EXPECT_EQ(door.drain(other), grpc::StatusCode::OK);
    EXPECT_EQ(door.registry.entries()[0].presence, Registry::Presence::Draining);
}

/// A renderer that offers itself.
struct Offer {
    Offer(const std::string& version, std::uint64_t protocol) {
        const auto door = GrpcService::start({"unix:" + folder.path("s")}, registry).value();
        const auto stub = registryAt("unix:" + folder.path("s"));
        v1::RegisterRendererRequest request;
        request.set_address("127.0.0.1:1");
        request.set_software_version(version);
        request.set_protocol_checksum(protocol);
        v1::RegisterRendererResponse response;
        grpc::ClientContext context;
        status = stub->RegisterRenderer(&context, request, &response);
    }

    const test::TemporaryFolder folder;
    Registry registry;
    grpc::Status status;
};

/// Turned down, and listed as such, by a message that has `found` and `expected`.
void expectRefused(const std::string& version, std::uint64_t protocol, const std::string& found,
                   const std::string& expected) {
    const Offer offer(version, protocol);
    EXPECT_EQ(offer.status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
    EXPECT_THAT(offer.status.error_message(),
                testing::AllOf(testing::HasSubstr(found), testing::HasSubstr(expected)));
    ASSERT_EQ(offer.registry.entries().size(), 1U);
    EXPECT_EQ(offer.registry.entries()[0].presence, Registry::Presence::Refused);
    EXPECT_EQ(offer.registry.entries()[0].why, offer.status.error_message());
}

/// "0.1." of 0.1.0.
std::string withoutPatch() {
    return std::string(fabric::kVersion.substr(0, fabric::kVersion.rfind('.') + 1));
}

TEST(CoordinatorGrpc, ARendererOfAnotherPatchIsLetIn) {
    const Offer offer(withoutPatch() + "97", wire::protocolChecksum());
    EXPECT_TRUE(offer.status.ok()) << offer.status.error_message();
    ASSERT_EQ(offer.registry.entries().size(), 1U);
    EXPECT_TRUE(offer.registry.entries()[0].isAlive());
}

TEST(CoordinatorGrpc, ARendererOfAnotherVersionIsTurnedDown) {
    for (const std::string& version : {std::string("0.97.0"), std::string("97.1.0"),
                                       std::string("0.1"), std::string(), withoutPatch() + "0.1"})
        expectRefused(version, wire::protocolChecksum(), "'" + version + "'",
                      std::string(fabric::kVersion));
}

TEST(CoordinatorGrpc, ARendererThatSpeaksOtherMessagesIsTurnedDown) {
    expectRefused(std::string(fabric::kVersion), 0xbeef, "000000000000beef",
                  fmt::format("{:016x}", wire::protocolChecksum()));
}

TEST(CoordinatorGrpc, ARendererThatDrawsOtherPicturesIsTurnedDown) {
    expectRefused(withoutPatch() + "97", wire::protocolChecksum(wire::kPictureVersion + 1),
                  "draws what the other does not", "install the same build");
}

}  // namespace
}  // namespace eyrie::service
