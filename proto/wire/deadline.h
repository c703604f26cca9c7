// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include <grpc/support/time.h>

/// Deadlines that the wall clock has nothing to do with: gRPC takes time points of that one by
/// default, and a call would end early, or never, when somebody sets it.
namespace eyrie::wire {

/// `time` from now, for grpc::ClientContext::set_deadline and grpc::Server::Shutdown.
inline gpr_timespec deadlineIn(std::chrono::nanoseconds time) {
    return gpr_time_add(gpr_now(GPR_CLOCK_MONOTONIC),
                        gpr_time_from_nanos(time.count(), GPR_TIMESPAN));
}

/// What is left until `deadline`, of grpc::ServerContext::raw_deadline or deadlineIn; negative
/// after it, and 31 years where it is farther off than that.
inline std::chrono::nanoseconds timeLeft(gpr_timespec deadline) {
    constexpr std::int64_t kFarSeconds = 1'000'000'000;
    const gpr_timespec left = gpr_time_sub(deadline, gpr_now(deadline.clock_type));
    if (left.tv_sec > kFarSeconds)  // there is none, as a rule
        return std::chrono::seconds(kFarSeconds);
    return std::chrono::seconds(left.tv_sec) + std::chrono::nanoseconds(left.tv_nsec);
}

}  // namespace eyrie::wire
