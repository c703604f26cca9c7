// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <utility>

#include <grpcpp/support/server_callback.h>

#include "coordinator/api/message_stream.h"
#include "wire/answer_limit.h"
#include "wire/status.h"

namespace eyrie::api {

/// A call whose answer goes on, over gRPC: sends one message after another, the next when the one
/// before has gone out, so that nothing is queued for who reads slowly. Ends when the caller goes,
/// its deadline passes, it takes no message for a while or there are no more. Ends itself.
template <typename Answer>
class StreamReactor final : public grpc::ServerWriteReactor<Answer> {
public:
    StreamReactor(grpc::CallbackServerContext& context, std::chrono::milliseconds patience)
        : limit_(context, patience) {}

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
        limit_.sends(sent_->ByteSizeLong());
        this->StartWrite(static_cast<const Answer*>(sent_.get()));
    }

    void finish(const absl::Status& status) {
        const std::lock_guard lock(mutex_);
        if (!std::exchange(isFinished_, true))
            this->Finish(wire::toGrpc(status));
    }

    void OnWriteDone(bool isGood) override {
        limit_.taken();
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

    wire::AnswerLimit limit_;
    std::unique_ptr<MessageStream> messages_;
    MessageStream::Message sent_;  ///< until it has gone out
    std::mutex mutex_;             ///< nothing is begun after the end; guards isFinished_
    bool isFinished_ = false;
};

}  // namespace eyrie::api
