// SPDX-License-Identifier: Apache-2.0
// A renderer process that does not keep to the protocol costs an error, never the coordinator.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>

#include "coordinator/farm/grpc_renderer.h"
#include "eyrie/v1/render_service.grpc.pb.h"
#include "tests/service/eventually.h"
#include "tests/support/temporary_folder.h"
#include "wire/listen.h"

namespace eyrie::coordinator {
namespace {

using Writer = grpc::ServerWriter<v1::RenderChannelResponse>;

class LyingService final : public v1::RenderService::Service {
public:
    grpc::Status OpenScene(grpc::ServerContext*, const v1::OpenSceneRequest*,
                           v1::OpenSceneResponse* response) override {
        response->mutable_bounds()->mutable_min()->set_x(std::numeric_limits<double>::quiet_NaN());
        return grpc::Status::OK;
    }
    grpc::Status RenderChannel(grpc::ServerContext*, const v1::RenderChannelRequest* request,
                               Writer* writer) override {
        keys.push_back(request->memory().key());
        answer(*writer);
        return grpc::Status::OK;
    }

    std::function<void(Writer&)> answer;
    std::vector<std::string> keys;  ///< of the memory that came with each task
};

class LyingRenderer : public testing::Test {
protected:
    static v1::RenderChannelResponse header(int side) {
        v1::RenderChannelResponse message;
        message.mutable_header()->mutable_area()->set_width(side);
        message.mutable_header()->mutable_area()->set_height(side);
        message.mutable_header()->set_pixel_bytes(static_cast<std::uint64_t>(side * side * 4));
        return message;
    }
    static v1::RenderChannelResponse chunk(std::size_t bytes) {
        v1::RenderChannelResponse message;
        message.set_chunk(std::string(bytes, 'x'));
        return message;
    }
    absl::Status render(std::chrono::milliseconds limit = std::chrono::seconds(20)) {
        const fabric::ChannelTask task{1, 1, 64, 64, {0, 0, 64, 64}, {}, false};
        return renderer_->render(task, ChannelRenderer::Clock::now() + limit).status();
    }

    test::TemporaryFolder folder_;
    LyingService service_;
    wire::Listening listening_ = wire::listen({"unix:" + folder_.path("s")}, service_).value();
    std::shared_ptr<ChannelRenderer> renderer_ = connectRenderer(listening_.addresses[0]);
};

TEST_F(LyingRenderer, AnAreaOutsideTheTaskIsAnErrorThatNamesIt) {
    service_.answer = [](Writer& writer) { writer.Write(header(65)); };
    const absl::Status status = render();
    EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
    EXPECT_THAT(std::string(status.message()),
                testing::AllOf(testing::HasSubstr(listening_.addresses[0]),
                               testing::HasSubstr("area is 65x65")));
}

TEST_F(LyingRenderer, WhatItAnswersWronglyIsToldInWords) {
    const absl::Status opened =
        renderer_->openScene({}, ChannelRenderer::Clock::now() + std::chrono::seconds(20)).status();
    EXPECT_EQ(opened.code(), absl::StatusCode::kInternal);
    EXPECT_THAT(std::string(opened.message()),
                testing::AllOf(testing::HasSubstr(": OpenScene answered "),
                               testing::Not(testing::HasSubstr("INVALID_ARGUMENT"))));
}

TEST_F(LyingRenderer, TooFewPixelsAreAnError) {
    service_.answer = [](Writer& writer) {
        writer.Write(header(64));
        writer.Write(chunk(100));
    };
    EXPECT_EQ(render().code(), absl::StatusCode::kInternal);
}

TEST_F(LyingRenderer, AStreamWithoutEndIsCutOff) {
    service_.answer = [](Writer& writer) {
        writer.Write(header(64));
        while (writer.Write(chunk(1000))) {
        }
    };
    EXPECT_EQ(render().code(), absl::StatusCode::kInternal);
}

/// What is in the memory then is not known; it is a picture of the size asked for all the same.
TEST_F(LyingRenderer, ThatAPictureIsInMemoryIsBelievedForWhatFitsTheTask) {
    v1::RenderChannelResponse good = header(64);
    good.mutable_header()->set_is_in_memory(true);
    service_.answer = [&](Writer& writer) { writer.Write(good); };
    EXPECT_TRUE(render().ok());
    EXPECT_TRUE(render().ok());
    EXPECT_EQ(service_.keys[0], service_.keys[1]);

    v1::RenderChannelResponse deep = good;  // twice as large as what was offered
    deep.mutable_header()->set_has_depth(true);
    deep.mutable_header()->set_pixel_bytes(64 * 64 * 8);
    service_.answer = [&](Writer& writer) { writer.Write(deep); };
    EXPECT_EQ(render().code(), absl::StatusCode::kInternal);
    service_.answer = [&](Writer& writer) {
        writer.Write(good);
        writer.Write(chunk(100));
    };
    EXPECT_EQ(render().code(), absl::StatusCode::kInternal);
}

TEST_F(LyingRenderer, MemoryOfACallThatFailedIsOfferedNoMore) {
    v1::RenderChannelResponse good = header(64);
    good.mutable_header()->set_is_in_memory(true);
    service_.answer = [](Writer&) {};
    EXPECT_FALSE(render().ok());
    service_.answer = [&](Writer& writer) { writer.Write(good); };
    EXPECT_TRUE(render().ok());
    EXPECT_TRUE(render().ok());
    ASSERT_EQ(service_.keys.size(), 3U);
    EXPECT_NE(service_.keys[0], service_.keys[1]);
    EXPECT_EQ(service_.keys[1], service_.keys[2]);
}

TEST_F(LyingRenderer, EmptyChunksWithoutEndRunIntoTheDeadline) {
    service_.answer = [](Writer& writer) {
        writer.Write(header(64));
        while (writer.Write(chunk(0))) {
        }
    };
    EXPECT_EQ(render(std::chrono::milliseconds(200)).code(), absl::StatusCode::kDeadlineExceeded);
}

TEST_F(LyingRenderer, AMessageBeyondTheLimitIsRefused) {
    service_.answer = [](Writer& writer) {
        writer.Write(header(64));
        writer.Write(chunk(std::size_t{16} << 20));
    };
    EXPECT_EQ(render().code(), absl::StatusCode::kResourceExhausted);
}

TEST_F(LyingRenderer, ABoxThatIsNoNumbersIsAnError) {
    const auto info =
        renderer_->openScene({}, ChannelRenderer::Clock::now() + std::chrono::seconds(20));
    EXPECT_EQ(info.status().code(), absl::StatusCode::kInternal);
}

TEST_F(LyingRenderer, AConnectionIsLostWhenThePeerEnds) {
    EXPECT_FALSE(renderer_->hasLostConnection());  // there is none yet
    service_.answer = [](Writer&) {};
    EXPECT_EQ(render().code(), absl::StatusCode::kInternal);
    EXPECT_FALSE(renderer_->hasLostConnection());
    listening_.server->Shutdown();
    EXPECT_TRUE(eventually([this] { return renderer_->hasLostConnection(); }));
}

TEST_F(LyingRenderer, OneThatIsGoneIsUnavailable) {
    listening_.server->Shutdown();
    EXPECT_EQ(render().code(), absl::StatusCode::kUnavailable);
}

}  // namespace
}  // namespace eyrie::coordinator
