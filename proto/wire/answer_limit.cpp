// SPDX-License-Identifier: Apache-2.0
#include "wire/answer_limit.h"

#include "wire/deadline.h"

namespace eyrie::wire {
namespace {

std::shared_ptr<grpc_call> shared(grpc_call* call) {
    grpc_call_ref(call);
    return {call, grpc_call_unref};
}

}  // namespace

AnswerLimit::AnswerLimit(grpc::CallbackServerContext& context, std::chrono::milliseconds patience)
    : call_(shared(context.c_call())), patience_(patience) {}

void AnswerLimit::sends(std::size_t bytes) {
    const std::chrono::milliseconds most =
        patience_ + std::chrono::milliseconds(bytes * 1000 / kSlowestBytesPerSecond);
    alarm_.emplace().Set(deadlineIn(most), [call = call_](bool isOver) {
        if (isOver)
            grpc_call_cancel(call.get(), nullptr);
    });
}

}  // namespace eyrie::wire
