// SPDX-License-Identifier: Apache-2.0
// Sessions of several viewers, through the door for browsers.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "coordinator/http/server.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/support/viewer_client.h"

namespace eyrie::http {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::ViewerClient;

class SharedSession : public testing::Test {
protected:
    SharedSession() {
        ServerOptions options;
        options.port = 0;
        auto server = Server::start(options, frames_);
        EXPECT_TRUE(server.ok()) << server.status();
        server_ = *std::move(server);
        const std::string url = server_->url();
        port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    }

    std::unique_ptr<ViewerClient> open(const std::string& query) const {
        auto client = ViewerClient::connect(port_, query);
        EXPECT_TRUE(client.ok()) << client.status();
        return *std::move(client);
    }

    static v1::ViewRequest view(std::uint64_t sequence) {
        v1::ViewRequest view;
        view.set_sequence(sequence);
        view.set_width(64);
        view.set_height(48);
        view.set_tau_pixels(1);
        for (const double value : {static_cast<double>(sequence), -10.0, 3.0})
            view.mutable_camera()->add_eye(value);
        for (int i = 0; i < 3; ++i) view.mutable_camera()->add_target(0);
        return view;
    }

    /// The next frame that comes, acknowledged.
    static v1::Frame frame(ViewerClient& client) {
        for (;;) {
            const auto response = client.receive(seconds(20));
            EXPECT_TRUE(response.ok()) << response.status();
            if (!response.ok())
                return {};
            if (!response->has_frame())
                continue;
            v1::ViewerRequest ack;
            ack.mutable_frame_ack()->set_frame_number(response->frame().frame_number());
            EXPECT_TRUE(client.send(ack).ok());
            return response->frame();
        }
    }

    coordinator::FakeFrameSource frames_;
    std::unique_ptr<Server> server_;
    std::uint16_t port_ = 0;
};

TEST_F(SharedSession, IsSeenByThoseWhoNameIt) {
    const auto leader = open("?session=review");
    const auto watcher = open("?session=review&role=watch");
    const auto stranger = open("?session=other");
    ASSERT_TRUE(leader->frameOf(view(5), seconds(20)).ok());
    const v1::Frame seen = frame(*watcher);
    EXPECT_EQ(seen.led_view().camera().eye(0), 5);
    EXPECT_EQ(watcher->state().place().session(), "review");
    EXPECT_FALSE(watcher->state().place().leads());
    const auto strange = stranger->receive(seconds(20));
    ASSERT_TRUE(strange.ok());
    EXPECT_TRUE(strange->has_state());
    EXPECT_EQ(strange->state().place().viewers(), 1);
    EXPECT_FALSE(stranger->receive(milliseconds(100)).ok());
}

TEST_F(SharedSession, GoesOnWhenItsLeaderVanishes) {
    auto leader = open("?session=review");
    const auto other = open("?session=review");
    ASSERT_TRUE(leader->frameOf(view(5), seconds(20)).ok());
    leader.reset();
    while (!other->state().place().leads()) ASSERT_TRUE(other->receive(seconds(20)).ok());
    const auto own = other->frameOf(view(6), seconds(20));
    ASSERT_TRUE(own.ok()) << own.status();
    EXPECT_EQ(own->view_sequence(), 6u);
}

TEST_F(SharedSession, IsRefusedUnderAnImproperName) {
    for (const std::string query : {"?session=", "?session=a%2Fb", "?session=a&role=king"})
        EXPECT_FALSE(ViewerClient::connect(port_, query).ok()) << query;
    EXPECT_TRUE(ViewerClient::connect(port_, "?session=a&role=lead").ok());
}

}  // namespace
}  // namespace eyrie::http
