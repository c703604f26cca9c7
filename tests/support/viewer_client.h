// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <absl/status/statusor.h>

#include "eyrie/v1/viewer.pb.h"

namespace eyrie::test {

/// A browser's side of viewer.proto, without a browser.
class ViewerClient {
public:
    using Milliseconds = std::chrono::milliseconds;

    /// Opens ws://127.0.0.1:port/ws, with `query` behind it. Errors: Unavailable.
    static absl::StatusOr<std::unique_ptr<ViewerClient>> connect(std::uint16_t port,
                                                                 const std::string& query = "");
    ~ViewerClient();
    ViewerClient(const ViewerClient&) = delete;
    ViewerClient& operator=(const ViewerClient&) = delete;

    absl::Status send(const v1::ViewerRequest& request);

    /// The next message. Errors: DeadlineExceeded (the next call may have it), Unavailable
    /// (closed).
    absl::StatusOr<v1::ViewerResponse> receive(Milliseconds limit);

    /// Asks for a view and answers with the next frame that shows it, whole, acknowledging all and
    /// keeping the newest state. DeadlineExceeded names the state's problem, if there is one.
    absl::StatusOr<v1::Frame> frameOf(const v1::ViewRequest& view, Milliseconds limit);

    /// As frameOf, but waits for the exact picture (a PNG) of a view that rests.
    absl::StatusOr<v1::Frame> exactFrameOf(const v1::ViewRequest& view, Milliseconds limit);

    const v1::SessionState& state() const { return state_; }

private:
    class Impl;
    enum class Wanted { Any, Exact };
    absl::StatusOr<v1::Frame> frameOf(const v1::ViewRequest& view, Milliseconds limit,
                                      Wanted wanted);
    absl::Status acknowledge(const v1::Frame& frame, std::size_t received);
    explicit ViewerClient(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
    v1::SessionState state_;
};

}  // namespace eyrie::test
