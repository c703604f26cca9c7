// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "coordinator/farm/grpc_renderer.h"
#include "eyrie/v1/render_service.grpc.pb.h"
#include "fake_drawer.h"
#include "service/render_server.h"
#include "tests/support/temporary_folder.h"
#include "wire/transport.h"

namespace eyrie::service {

inline coordinator::ChannelRenderer::Clock::time_point soon() {
    return coordinator::ChannelRenderer::Clock::now() + std::chrono::seconds(20);
}

/// Its picture, in messages or in memory.
inline fabric::Image arrivedIn(const fabric::ChannelResult& result) {
    return result.lent ? fabric::copied(result.lent->view()) : result.image;
}

/// A renderer whose drawer is a fake, and a coordinator's connection to it.
class RenderServerTest : public testing::Test {
protected:
    RenderServerTest()
        : thread_(GlThread::start(fakeDrawers(control_)).value()),
          server_(RenderServer::start("unix:" + folder_.path("s"), *thread_).value()),
          renderer_(coordinator::connectRenderer(server_->address())),
          stub_(v1::RenderService::NewStub(grpc::CreateCustomChannel(
              server_->address(), grpc::InsecureChannelCredentials(), wire::clientArguments()))) {}

    static fabric::FrameData frameData() { return {1, {}, 2, fabric::Shading::Flat}; }
    static fabric::ChannelTask task(int width, int height, bool wantsDepth) {
        return {1, 1, width, height, {0, 0, width, height}, {}, wantsDepth};
    }

    test::TemporaryFolder folder_;
    std::shared_ptr<FakeDrawerControl> control_ = std::make_shared<FakeDrawerControl>();
    std::unique_ptr<GlThread> thread_;
    std::unique_ptr<RenderServer> server_;
    std::shared_ptr<coordinator::ChannelRenderer> renderer_;
    std::unique_ptr<v1::RenderService::Stub> stub_;
};

}  // namespace eyrie::service
