// SPDX-License-Identifier: Apache-2.0
// Pictures that nobody waits for any more are given up by the real programs, over HTTP and gRPC.
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include "eyrie/v1/coordinator_service.grpc.pb.h"
#include "tests/support/http_client.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

/// A coordinator with one renderer.
class GoneClients : public testing::Test {
protected:
    void SetUp() override {
        const std::vector<std::string> environment = {"XDG_CACHE_HOME=" + folder_.path("cache")};
        coordinator_ = std::make_unique<test::Process>(
            test::eyrieCommand({"coordinator", EYRIE_SOURCE_DIR "/demo/rocker_arm.ply", "--listen",
                                "127.0.0.1:0", "--grpc", "127.0.0.1:0"}),
            environment);
        ASSERT_TRUE(coordinator_->waitForOutput("Renderers register at ", seconds(120)) &&
                    coordinator_->waitForOutput("\n", seconds(5)))
            << coordinator_->errors();
        http_ = portAfter("Eyrie is at ");
        grpc_ = "127.0.0.1:" + std::to_string(portAfter("Renderers register at "));
        renderer_ = std::make_unique<test::Process>(
            test::eyrieCommand({"renderer", "--coordinator", grpc_, "--listen", "127.0.0.1:0"}),
            environment);
        ASSERT_TRUE(test::eventually(seconds(120), [&] { return isReady(); }))
            << renderer_->errors();
    }

    std::uint16_t portAfter(const std::string& text) const {
        const std::string output = coordinator_->output();
        const std::size_t begin = output.find(text);
        const std::string line = output.substr(begin, output.find('\n', begin) - begin);
        return static_cast<std::uint16_t>(std::atoi(line.c_str() + line.rfind(':') + 1));
    }

    bool isReady() const {
        const auto answer = test::httpGet(http_, "/readyz");
        return answer.ok() && answer->status == 200;
    }

    int cancelledFrames() const {
        constexpr std::string_view kSeries = "eyrie_frames_total{result=\"cancelled\"} ";
        const auto answer = test::httpGet(http_, "/metrics");
        const std::size_t at = answer.ok() ? answer->body.find(kSeries) : std::string::npos;
        return at == std::string::npos ? 0 : std::atoi(&answer->body[at + kSeries.size()]);
    }

    /// Asks and goes away until a frame had begun by then; whether it was given up.
    template <typename Ask>
    bool isGivenUp(const Ask& askAndGo) {
        const int before = cancelledFrames();
        for (int patience = 100; patience < 30'000; patience *= 2) {
            askAndGo(milliseconds(patience));
            if (test::eventually(seconds(2), [&] { return cancelledFrames() > before; }))
                return true;
        }
        return false;
    }

    /// The renderer is there, has nothing else to do and draws what is asked for.
    void expectPicture() const {
        EXPECT_TRUE(test::eventually(seconds(30), [&] { return isReady(); }));
        const auto picture =
            test::httpGet(http_, "/api/v1/image?width=320&height=180", seconds(100));
        ASSERT_TRUE(picture.ok()) << picture.status();
        EXPECT_EQ(picture->status, 200);
        EXPECT_THAT(picture->headers, HasSubstr("Eyrie-Complete: true"));
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<test::Process> coordinator_;
    std::unique_ptr<test::Process> renderer_;
    std::uint16_t http_ = 0;
    std::string grpc_;
};

TEST_F(GoneClients, OfHttpHaveTheirPicturesGivenUp) {
    EXPECT_TRUE(isGivenUp([&](milliseconds patience) {
        const auto answer =
            test::httpGet(http_, "/api/v1/image?width=8192&height=4096&tauPixels=0.01", patience);
        EXPECT_FALSE(answer.ok() && answer->status != 200);
    }));
    expectPicture();
}

TEST_F(GoneClients, OfGrpcHaveTheirPicturesGivenUpAtTheirDeadlines) {
    const auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel(grpc_, grpc::InsecureChannelCredentials()));
    EXPECT_TRUE(isGivenUp([&](milliseconds patience) {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() + patience);
        v1::RenderImageRequest request;
        request.set_width(8192);
        request.set_height(4096);
        request.set_tau_pixels(0.01);
        request.set_format(v1::IMAGE_FORMAT_JPEG);
        v1::RenderImageResponse response;
        EXPECT_FALSE(stub->RenderImage(&context, request, &response).ok());
    }));
    expectPicture();
}

}  // namespace
}  // namespace eyrie
