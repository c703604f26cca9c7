// SPDX-License-Identifier: Apache-2.0
#include "service/pick_thread.h"

#include <atomic>
#include <future>
#include <new>
#include <vector>

#include <gtest/gtest.h>

namespace eyrie::service {
namespace {

constexpr auto kNever = std::chrono::steady_clock::time_point::max();

TEST(PickThread, WithoutASceneThereIsNothingToPick) {
    PickThread thread;
    absl::Status status;
    thread.pick({}, kNever, [&](const auto& picked) { status = picked.status(); });
    EXPECT_TRUE(absl::IsFailedPrecondition(status));
}

TEST(PickThread, WithoutMemoryOnePickFailsAndTheNextIsMade) {
    PickThread thread;
    const auto picked = [&thread] {
        std::promise<absl::Status> status;
        thread.pick({}, kNever, [&](const auto& answer) { status.set_value(answer.status()); });
        return status.get_future().get();
    };
    thread.use([](const auto&, auto) -> absl::StatusOr<fabric::Picked> { throw std::bad_alloc(); });
    EXPECT_TRUE(absl::IsResourceExhausted(picked()));
    thread.use([](const auto&, auto) { return fabric::Picked(); });
    EXPECT_TRUE(picked().ok());
}

TEST(PickThread, RefusesPicksBeyondItsBoundAndAnswersAllOthers) {
    std::atomic<int> answered{0};
    std::atomic<int> refused{0};
    const auto done = [&](const absl::StatusOr<fabric::Picked>& picked) {
        ++(absl::IsResourceExhausted(picked.status()) ? refused : answered);
    };
    std::promise<void> release;
    const std::shared_future<void> released = release.get_future().share();
    {
        PickThread thread;
        thread.use([&](const fabric::PickRequest&, auto) -> absl::StatusOr<fabric::Picked> {
            released.wait();
            return fabric::Picked();
        });
        for (std::size_t i = 0; i < PickThread::kMaxQueued + 3; ++i) thread.pick({}, kNever, done);
        EXPECT_GE(refused, 2);
        release.set_value();
    }
    // What was queued when it ended is answered, too.
    EXPECT_EQ(static_cast<std::size_t>(answered + refused), PickThread::kMaxQueued + 3);
}

}  // namespace
}  // namespace eyrie::service
