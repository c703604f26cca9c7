// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_sequence.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace eyrie::coordinator {
namespace {

class Asker {
public:
    explicit Asker(const FrameSequence& sequence) : sequence_(sequence) {}

    /// Asks for one frame after another until there are no more.
    void ask() {
        while (askOnce()) {
        }
    }

    absl::Status status() const { return status_; }

private:
    bool askOnce() {
        std::optional<std::size_t> index;
        FrameSequence::Clock::time_point begun;
        auto drawn = sequence_.draw([&] { return choose(index, begun); });
        std::unique_lock lock(takeMutex_);
        if (!index) {
            if (!isOver_)  // not even a view was asked for
                end(drawn.status());
            return false;
        }
        turn_.wait(lock, [&] { return taken_ == *index; });
        if (status_.ok()) {
            const auto now = FrameSequence::Clock::now();
            end(sequence_.take({*index, begun, now, std::move(drawn)}));
        }
        ++taken_;
        turn_.notify_all();
        return true;
    }

    void end(absl::Status status) {
        if (status.ok())
            return;
        status_.Update(status);
        isOver_ = true;
    }

    std::optional<FrameRequest> choose(std::optional<std::size_t>& index,
                                       FrameSequence::Clock::time_point& begun) {
        const std::lock_guard lock(viewMutex_);
        if (isOver_)
            return std::nullopt;
        std::optional<FrameRequest> view = sequence_.view(begun_);
        if (view)
            index = begun_++;
        else
            isOver_ = true;
        begun = FrameSequence::Clock::now();
        return view;
    }

    const FrameSequence& sequence_;
    std::atomic<bool> isOver_{false};  ///< no more begin
    std::mutex viewMutex_;             ///< guards what follows
    std::size_t begun_ = 0;            ///< frames
    std::mutex takeMutex_;             ///< guards what follows; taking one may take its time
    std::condition_variable turn_;
    std::size_t taken_ = 0;
    absl::Status status_;
};

}  // namespace

absl::Status drawSequence(const FrameSequence& sequence) {
    Asker asker(sequence);
    {
        std::vector<std::jthread> threads;
        for (int i = 1; i < sequence.atOnce; ++i) threads.emplace_back([&] { asker.ask(); });
        asker.ask();
    }
    return asker.status();
}

}  // namespace eyrie::coordinator
