// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>

#include <grpc/grpc.h>
#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>

namespace eyrie::wire {

/// Cancels a call whose answer nobody takes: it would hold memory, and its share of what there is
/// for all, for as long as its connection lasts. How much of a message has gone cannot be known, so
/// each has a time by its size. Belongs to the call's reactor.
class AnswerLimit {
public:
    static constexpr std::chrono::seconds kPatience{30};
    static constexpr std::size_t kSlowestBytesPerSecond = 256 * 1024;

    /// `patience`: for each message, beside what the slowest takes for its bytes.
    explicit AnswerLimit(grpc::CallbackServerContext& context,
                         std::chrono::milliseconds patience = kPatience);

    /// A message of so many bytes is about to be sent, after taken() of the one before.
    void sends(std::size_t bytes);
    void taken() { alarm_.reset(); }

private:
    const std::shared_ptr<grpc_call> call_;  ///< the alarm may end it when the reactor has gone
    const std::chrono::milliseconds patience_;
    std::optional<grpc::Alarm> alarm_;
};

}  // namespace eyrie::wire
