// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>

#include <absl/status/status.h>
#include <grpcpp/support/server_callback.h>

#include "eyrie/v1/render_service.grpc.pb.h"
#include "fabric/channel_task.h"

namespace eyrie::service {

/// The answer to one RenderChannel call: a header, then the pixels in chunks. One chunk is copied
/// at a time, so a slow reader costs its picture and one chunk, no more.
///
/// Owns itself, as gRPC's reactors do: exactly one of send and fail must be called, once, from any
/// thread; the object then goes when gRPC has done with it.
class ReplyStream final : public grpc::ServerWriteReactor<v1::RenderChannelResponse> {
public:
    /// Calls `onGone` when the answer has left or was given up.
    explicit ReplyStream(std::function<void()> onGone) : onGone_(std::move(onGone)) {}

    /// True once nobody waits for the answer any more.
    bool isCancelled() const { return cancelled_.load(std::memory_order_relaxed); }

    void send(fabric::ChannelResult result);
    void fail(const absl::Status& status);

    void OnWriteDone(bool ok) override;
    void OnCancel() override { cancelled_.store(true, std::memory_order_relaxed); }
    void OnDone() override;

private:
    void writeNext();
    /// The bytes at `sent_` up to the end of colour or depth, whichever comes first.
    std::span<const char> nextChunk() const;

    std::function<void()> onGone_;
    std::atomic<bool> cancelled_{false};
    fabric::ChannelResult result_;
    std::size_t total_ = 0;
    std::size_t sent_ = 0;
    v1::RenderChannelResponse message_;
};

}  // namespace eyrie::service
