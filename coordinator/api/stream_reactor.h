// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include <grpcpp/support/server_callback.h>

#include "coordinator/api/message_stream.h"
#include "wire/status.h"

namespace eyrie::api {

/// A call whose answer goes on, over gRPC: sends one message after another, the next when the one
/// before has gone out, so that nothing is queued for who reads slowly. Ends when the caller goes,
/// its deadline passes or there are no more messages. Ends itself.
template <typename Answer>
class StreamReactor final : public grpc::ServerWriteReactor<Answer> {
public:
    /// Why there is no answer, or what it is.
    void begin(absl::StatusOr<std::unique_ptr<MessageStream>> messages) {
        if (!messages.ok())
            return finish(messages.status());
        messages_ = *std::move(messages);
        ask();
    }

private:
    void ask() {
        messages_->next(
            [this](const absl::StatusOr<MessageStream::Message>& message) { came(message); });
    }

    void came(const absl::StatusOr<MessageStream::Message>& message) {
        if (!message.ok())
            return finish(message.status());
        const std::lock_guard lock(mutex_);
        if (isFinished_)
            return;
        sent_ = *message;
        this->StartWrite(static_cast<const Answer*>(sent_.get()));
    }

    void finish(const absl::Status& status) {
        const std::lock_guard lock(mutex_);
        if (!std::exchange(isFinished_, true))
            this->Finish(wire::toGrpc(status));
    }

    void OnWriteDone(bool isGood) override {
        if (isGood)
            ask();
        else
            finish(absl::CancelledError("the caller has gone"));
    }
    void OnCancel() override { finish(absl::CancelledError("the caller has gone")); }
    void OnDone() override {
        messages_.reset();  // it may be about to tell something, and then touches this
        delete this;
    }

    std::unique_ptr<MessageStream> messages_;
    MessageStream::Message sent_;  ///< until it has gone out
    std::mutex mutex_;             ///< nothing is begun after the end; guards isFinished_
    bool isFinished_ = false;
};

}  // namespace eyrie::api
