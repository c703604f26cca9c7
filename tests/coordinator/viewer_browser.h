// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "coordinator/stream/pacer.h"
#include "coordinator/stream/viewer.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"

namespace eyrie::stream {

inline std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text));
}

inline v1::ViewerRequest viewMessage(std::uint64_t sequence, double eyeX) {
    v1::ViewerRequest request;
    v1::ViewRequest& view = *request.mutable_view();
    view.set_sequence(sequence);
    view.set_width(64);
    view.set_height(48);
    view.set_tau_pixels(1);
    for (const double value : {eyeX, -10.0, 3.0}) view.mutable_camera()->add_eye(value);
    for (int i = 0; i < 3; ++i) view.mutable_camera()->add_target(0);
    return request;
}

/// The browser's end of a viewer.
class Browser {
public:
    /// Of a session of its own.
    explicit Browser(coordinator::FakeFrameSource& frames, const SessionOptions& options = {})
        : own_(std::make_unique<Sessions>(frames, options)),
          viewer_(*own_, {}, [this] { ready(); }) {}

    explicit Browser(Sessions& sessions, const Joining& joining)
        : viewer_(sessions, joining, [this] { ready(); }) {}

    void send(const v1::ViewerRequest& request) {
        ASSERT_TRUE(viewer_.receive(bytesOf(request.SerializeAsString())).ok());
    }

    void look(std::uint64_t sequence) {
        send(viewMessage(sequence, static_cast<double>(sequence)));
    }

    void acknowledge(std::uint64_t frameNumber) {
        v1::ViewerRequest request;
        request.mutable_frame_ack()->set_frame_number(frameNumber);
        send(request);
    }

    /// Takes the parts of a frame's picture until it is whole, and acknowledges them and the frame.
    void receiveWhole(v1::Frame& frame) {
        std::string& picture = frame.has_png() ? *frame.mutable_png() : *frame.mutable_jpeg();
        v1::ViewerRequest request;
        request.mutable_frame_ack()->set_frame_number(frame.frame_number());
        while (picture.size() < frame.picture_bytes()) {
            request.mutable_frame_ack()->set_received_bytes(picture.size());
            send(request);
            const std::optional<v1::ViewerResponse> response = next();
            ASSERT_TRUE(response && response->has_frame_part());
            ASSERT_EQ(response->frame_part().frame_number(), frame.frame_number());
            ASSERT_EQ(response->frame_part().offset(), picture.size());
            picture += response->frame_part().bytes();
        }
        acknowledge(frame.frame_number());
    }

    /// The next message within `patience`.
    std::optional<v1::ViewerResponse> next(
        std::chrono::milliseconds patience = std::chrono::milliseconds(10'000)) {
        const auto deadline = Clock::now() + patience;
        for (;;) {
            if (std::optional<std::string> bytes = viewer_.takeMessage(); bytes.has_value()) {
                v1::ViewerResponse response;
                EXPECT_TRUE(response.ParseFromString(*bytes));
                return response;
            }
            std::unique_lock lock(mutex_);
            if (!changed_.wait_until(lock, deadline, [this] { return isReady_; }))
                return std::nullopt;
            isReady_ = false;
        }
    }

    std::optional<v1::Frame> nextFrame(
        std::chrono::milliseconds patience = std::chrono::milliseconds(10'000)) {
        for (;;) {
            const std::optional<v1::ViewerResponse> response = next(patience);
            if (!response.has_value())
                return std::nullopt;
            if (response->has_frame())
                return response->frame();
        }
    }

    /// The next state for which `isWanted`; none after ten seconds.
    template <typename Predicate>
    std::optional<v1::SessionState> stateWhere(Predicate isWanted) {
        for (;;) {
            const std::optional<v1::ViewerResponse> response = next();
            if (!response.has_value())
                return std::nullopt;
            if (response->has_state() && isWanted(response->state()))
                return response->state();
        }
    }

    Viewer& viewer() { return viewer_; }

private:
    void ready() {
        {
            const std::lock_guard lock(mutex_);
            isReady_ = true;
        }
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    bool isReady_ = false;
    std::unique_ptr<Sessions> own_;
    Viewer viewer_;  // last: it calls ready() until it is gone
};

/// Never comes to rest, so that every frame is a moving one.
inline SessionOptions moving(int framesInFlight) {
    SessionOptions options;
    options.framesInFlight = framesInFlight;
    options.restDelay = std::chrono::hours(1);
    return options;
}

inline SessionOptions resting() {
    SessionOptions options;
    options.framesInFlight = 2;
    options.restDelay = std::chrono::milliseconds(50);
    return options;
}

}  // namespace eyrie::stream
