// SPDX-License-Identifier: Apache-2.0
// The same calls by gRPC.
#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include <grpcpp/create_channel.h>
#include <grpcpp/server.h>
#include <grpcpp/support/channel_arguments.h>
#include <gtest/gtest.h>

#include "coordinator/api/coordinator_service.h"
#include "coordinator/api/grpc_service.h"
#include "tests/coordinator/rest_fixture.h"
#include "wire/listen.h"

namespace eyrie::api {
namespace {

TEST_F(Rest, IsTheSameOverGrpc) {
    CoordinatorService service;
    const auto listening =
        wire::listen({"unix:" + folder_.path("s")}, std::vector<grpc::Service*>{&service}).value();
    auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel("unix:" + folder_.path("s"), grpc::InsecureChannelCredentials()));
    const auto status = [&](auto&& call) {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
        return call(context);
    };
    v1::RenderImageRequest request;
    request.set_width(20);
    request.set_height(10);
    v1::RenderImageResponse response;
    const auto render = [&](grpc::ClientContext& context) {
        return stub->RenderImage(&context, request, &response);
    };
    EXPECT_EQ(status(render).error_code(), grpc::StatusCode::UNAVAILABLE);  // still starting
    service.use(api_->handlers());
    ASSERT_TRUE(status(render).ok());
    EXPECT_EQ(response.image(), *get("/image?width=20&height=10").body);
    request.set_width(0);
    EXPECT_EQ(status(render).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    listening.server->Shutdown();
    service.stop();
}

TEST_F(Rest, AddressesInScenesAreWholeOverGrpcForThoseAloneWhoMayShowThemAgain) {
    const std::string address = "https://joe:sekret@host/a.eyt?sig=S";
    const std::string view = "view-0123456789abcdef0123456789";
    const std::string control = "control-0123456789abcdef0123456789";
    fabric::Scene scene;
    scene.objects.push_back({"a", fabric::ObjectKind::Terrain, address});
    api_->begin(scene, scene);
    wire::Security security;
    security.gate = std::make_shared<access::Gate>(
        *access::Tokens::parse("view " + view + "\ncontrol " + control + "\n", "t"));
    CoordinatorService service(security);
    service.use(api_->handlers());
    const auto listening =
        wire::listen({"127.0.0.1:0"}, std::vector<grpc::Service*>{&service}).value();
    auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel(listening.addresses.front(), grpc::InsecureChannelCredentials()));
    const auto addressFor = [&](const std::string& token) {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
        context.AddMetadata("authorization", "Bearer " + token);
        v1::GetSceneResponse response;
        EXPECT_TRUE(stub->GetScene(&context, {}, &response).ok());
        return response.scene().objects_size() == 1 ? response.scene().objects(0).terrain() : "";
    };
    EXPECT_EQ(addressFor(view), "https://…@host/a.eyt?…");
    EXPECT_EQ(addressFor(control), address);
    listening.server->Shutdown();
    service.stop();
}

TEST_F(Rest, PicturesAreAsLargeOverGrpc) {
    frames_.setDraw([](const coordinator::FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {1, 2, 3, 255});
        frame.image = fabric::makeImage(request.drawnPart(), {1, 2, 3, 255}, true);
        return frame;
    });
    coordinator::Registry registry;
    const auto door =
        coordinator::GrpcService::start({"unix:" + folder_.path("s")}, registry).value();
    door->use(api_->handlers());
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(-1);
    auto stub = v1::CoordinatorService::NewStub(grpc::CreateCustomChannel(
        "unix:" + folder_.path("s"), grpc::InsecureChannelCredentials(), arguments));
    v1::RenderImageRequest request;
    request.set_width(1920);
    request.set_height(1080);
    request.set_format(v1::IMAGE_FORMAT_RAW);
    request.set_with_depth(true);
    v1::RenderImageResponse response;
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    const grpc::Status status = stub->RenderImage(&context, request, &response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(response.image().size(), 4U * 1920 * 1080);
    EXPECT_EQ(response.depth().size(), 4U * 1920 * 1080);
}

TEST_F(Rest, GrpcCallsInProgressAreAnsweredByAServerThatStops) {
    coordinator::Registry registry;
    const auto door =
        coordinator::GrpcService::start({"unix:" + folder_.path("s")}, registry).value();
    door->use(api_->handlers());
    auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel("unix:" + folder_.path("s"), grpc::InsecureChannelCredentials()));
    const auto render = [&] {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
        v1::RenderImageRequest request;
        request.set_width(20);
        request.set_height(10);
        v1::RenderImageResponse response;
        return stub->RenderImage(&context, request, &response).error_code();
    };
    frames_.hold(true);
    auto picture = std::async(std::launch::async, render);
    ASSERT_TRUE(frames_.waitForRequests(1));
    door->drain();
    EXPECT_EQ(render(), grpc::StatusCode::UNAVAILABLE);
    std::jthread stopping([&] { door->stop(); });
    frames_.hold(false);
    EXPECT_EQ(picture.get(), grpc::StatusCode::OK);
}

TEST_F(Rest, TellsTheHandlerThatAGrpcCallerHasGone) {
    CoordinatorService service;
    service.use(api_->handlers());
    const auto listening =
        wire::listen({"unix:" + folder_.path("s")}, std::vector<grpc::Service*>{&service}).value();
    auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel("unix:" + folder_.path("s"), grpc::InsecureChannelCredentials()));
    frames_.setPick([](const fabric::PickRequest&) {  // 512 of them take longer than anybody waits
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return fabric::Picked();
    });
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(1));
    v1::MeasureProfileRequest request;
    request.set_samples(512);
    v1::MeasureProfileResponse response;
    EXPECT_EQ(stub->MeasureProfile(&context, request, &response).error_code(),
              grpc::StatusCode::DEADLINE_EXCEEDED);
    listening.server->Shutdown();
    service.stop();
    EXPECT_LT(frames_.picks().size(), 512U);
}

}  // namespace
}  // namespace eyrie::api
