// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <set>
#include <stop_token>

namespace eyrie::coordinator {

/// Lets frames begin in the order in which they were asked for, so that no viewer starves, a few at
/// a time, and end in the order in which they began. All functions may be called from any thread.
class FrameGate {
public:
    /// Whether another frame would find something to do while others are under way.
    using IsWorthwhile = std::function<bool()>;

    using Clock = std::chrono::steady_clock;
    using Now = std::function<Clock::time_point()>;

    explicit FrameGate(IsWorthwhile isWorthwhile, Now now = Clock::now)
        : isWorthwhile_(std::move(isWorthwhile)), now_(std::move(now)) {}
    FrameGate(const FrameGate&) = delete;
    FrameGate& operator=(const FrameGate&) = delete;

    /// A frame under way.
    class Pass {
    public:
        /// Waits for the turn: until those before have let the next and none is under way, or fewer
        /// than the limit and another is worthwhile, and the interval is over. Or until `stop`:
        /// then it has none, and those behind it move up.
        explicit Pass(FrameGate& gate, const std::stop_token& stop = {});
        /// The frame has ended, in order or not.
        ~Pass();
        Pass(const Pass&) = delete;
        Pass& operator=(const Pass&) = delete;

        /// False after `stop` had come before the turn: the frame must not begin.
        bool hasTurn() const { return hasTurn_; }

        /// Of frames under way at the same time no two are the same, nor are their remainders by
        /// the limit or more.
        std::uint64_t ticket() const { return ticket_; }

        /// The frame has its renderers: the next may begin where others have nothing to do.
        void letNext();

        /// Waits until those that began before have ended.
        void awaitEarlier();

    private:
        FrameGate& gate_;
        const std::uint64_t ticket_;
        bool hasTurn_ = false;
        bool hasLetNext_ = false;
    };

    /// How many frames may be under way, 1 or more.
    void setLimit(int limit);

    /// How long after one has begun the next may; 0 at first. Frames of renderers that take turns
    /// come at even times so, not as two or three happen to be free together.
    void setInterval(Clock::duration interval);

    /// Another frame may have become worthwhile, or the interval be over.
    void look();

private:
    bool mayBegin() const;
    Clock::duration pause() const;
    void moveUp();

    const IsWorthwhile isWorthwhile_;
    const Now now_;
    std::mutex mutex_;  ///< guards what follows; held while isWorthwhile_ is asked
    std::condition_variable_any changed_;
    std::size_t limit_ = 1;
    Clock::duration interval_{};
    Clock::time_point begun_{};           ///< the last frame
    std::uint64_t issued_ = 0;            ///< tickets
    std::uint64_t next_ = 0;              ///< ticket whose turn it is
    std::set<std::uint64_t> gone_;        ///< tickets that are later than that and were given up
    std::deque<std::uint64_t> underWay_;  ///< in the order in which they began
};

}  // namespace eyrie::coordinator
