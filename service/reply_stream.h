// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>

#include <absl/status/status.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "service/reply_slots.h"
#include "wire/answer_limit.h"
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
/// costs what the source holds and one message, no more, and one that takes none is cancelled.
///
/// Owns itself, as gRPC's reactors do: exactly one of send and fail must be called, once, from any
/// thread; the object then goes when gRPC has done with it.
template <typename Message>
class ReplyStream final : public grpc::ServerWriteReactor<Message> {
public:
    /// Takes one of `slots`, which outlive it. `patience`: wire::AnswerLimit's.
    ReplyStream(grpc::CallbackServerContext& context, ReplySlots& slots,
                std::chrono::milliseconds patience)
        : context_(context), slots_(slots), limit_(context, patience) {
        slots_.open();
    }

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
    void fail(const absl::Status& status) { finish(wire::toGrpc(status)); }

    void OnWriteDone(bool ok) override {
        limit_.taken();
        if (source_ == nullptr)
            return;  // Finish was called with the last one.
        if (!ok || isCancelled())
            finish(grpc::Status::CANCELLED);
        else
            writeNext();
    }
    void OnCancel() override { cancelled_.request_stop(); }
    void OnDone() override {
        slots_.close(lastBytes_);
        delete this;
    }

private:
    void writeNext() {
        source_->next(message_);
        const std::size_t bytes = message_.ByteSizeLong();
        limit_.sends(bytes);
        if (!source_->isDone())
            return this->StartWrite(&message_);
        source_ = nullptr;
        lastBytes_ = bytes;
        slots_.leave(lastBytes_);  // first: a reader may ask for more as soon as it has this
        this->StartWriteAndFinish(&message_, {}, grpc::Status::OK);
    }
    void finish(const grpc::Status& status) {
        source_ = nullptr;
        slots_.leave(0);
        this->Finish(status);
    }

    grpc::CallbackServerContext& context_;
    ReplySlots& slots_;
    wire::AnswerLimit limit_;
    std::stop_source cancelled_;
    std::unique_ptr<MessageSource<Message>> source_;  ///< of the messages after this one
    Message message_;
    std::size_t lastBytes_ = 0;
};

}  // namespace eyrie::service
