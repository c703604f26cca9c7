// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>

#include <absl/status/status.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "wire/status.h"

namespace eyrie::service {

/// The messages of an answer, made one by one when there is room for them.
template <typename Message>
class MessageSource {
public:
    virtual ~MessageSource() = default;

    /// False for a source that has not been asked yet: an answer has one message at least.
    virtual bool isDone() const = 0;
    /// Replaces `message` with the next one.
    virtual void next(Message& message) = 0;
};

/// The answer to one call as a stream of messages. One message is made at a time, so a slow reader
/// costs what the source holds and one message, no more.
///
/// Owns itself, as gRPC's reactors do: exactly one of send and fail must be called, once, from any
/// thread; the object then goes when gRPC has done with it.
template <typename Message>
class ReplyStream final : public grpc::ServerWriteReactor<Message> {
public:
    /// Calls `onGone` when the answer has left or was given up.
    ReplyStream(grpc::CallbackServerContext& context, std::function<void()> onGone)
        : context_(context), onGone_(std::move(onGone)) {}

    /// True once nobody waits for the answer any more.
    bool isCancelled() const { return cancelled_.stop_requested(); }
    std::stop_token cancellation() const { return cancelled_.get_token(); }

    /// Sends the initial metadata, with `key` among them, before there is an answer: once at most,
    /// before send or fail, by the thread that calls one of these.
    void sendEarly(const std::string& key) {
        context_.AddInitialMetadata(key, "");
        this->StartSendInitialMetadata();
    }

    void send(std::unique_ptr<MessageSource<Message>> source) {
        source_ = std::move(source);
        writeNext();
    }
    void fail(const absl::Status& status) { this->Finish(wire::toGrpc(status)); }

    void OnWriteDone(bool ok) override {
        if (source_->isDone())
            return;  // Finish was called with the last one.
        if (!ok || isCancelled())
            this->Finish(grpc::Status::CANCELLED);
        else
            writeNext();
    }
    void OnCancel() override { cancelled_.request_stop(); }
    void OnDone() override {
        onGone_();
        delete this;
    }

private:
    void writeNext() {
        source_->next(message_);
        if (source_->isDone())
            this->StartWriteAndFinish(&message_, {}, grpc::Status::OK);
        else
            this->StartWrite(&message_);
    }

    grpc::CallbackServerContext& context_;
    std::function<void()> onGone_;
    std::stop_source cancelled_;
    std::unique_ptr<MessageSource<Message>> source_;
    Message message_;
};

}  // namespace eyrie::service
