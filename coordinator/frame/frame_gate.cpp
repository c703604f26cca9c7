// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_gate.h"

#include <utility>

namespace eyrie::coordinator {

FrameGate::Pass::Pass(FrameGate& gate, const std::stop_token& stop)
    : gate_(gate), ticket_([&] {
          const std::lock_guard lock(gate.mutex_);
          return gate.issued_++;
      }()) {
    std::unique_lock lock(gate_.mutex_);
    const auto isNext = [&] { return gate_.next_ == ticket_ && gate_.mayBegin(); };
    const auto isOver = [&] { return gate_.pause() <= Clock::duration::zero(); };
    while (!hasTurn_ && gate_.changed_.wait(lock, stop, isNext)) {
        hasTurn_ = isOver();
        if (!hasTurn_ && !gate_.changed_.wait_for(lock, stop, gate_.pause(), isOver) &&
            stop.stop_requested())
            break;
    }
    if (hasTurn_) {
        gate_.begun_ = gate_.now_();
        gate_.underWay_.push_back(ticket_);
        return;
    }
    hasLetNext_ = true;
    gate_.gone_.insert(ticket_);
    gate_.moveUp();
    gate_.changed_.notify_all();
}

FrameGate::Pass::~Pass() {
    letNext();
    {
        const std::lock_guard lock(gate_.mutex_);
        std::erase(gate_.underWay_, ticket_);
    }
    gate_.changed_.notify_all();
}

void FrameGate::Pass::letNext() {
    if (std::exchange(hasLetNext_, true))
        return;
    {
        const std::lock_guard lock(gate_.mutex_);
        ++gate_.next_;
        gate_.moveUp();
    }
    gate_.changed_.notify_all();
}

void FrameGate::Pass::awaitEarlier() {
    std::unique_lock lock(gate_.mutex_);
    gate_.changed_.wait(lock, [this] { return gate_.underWay_.front() == ticket_; });
}

bool FrameGate::mayBegin() const {
    return underWay_.empty() || (underWay_.size() < limit_ && isWorthwhile_());
}

/// What is left of the interval; none has begun before the first.
FrameGate::Clock::duration FrameGate::pause() const {
    return begun_ == Clock::time_point() ? Clock::duration() : begun_ + interval_ - now_();
}

/// Past those that were given up.
void FrameGate::moveUp() {
    while (gone_.erase(next_) != 0) ++next_;
}

void FrameGate::setLimit(int limit) {
    {
        const std::lock_guard lock(mutex_);
        limit_ = static_cast<std::size_t>(limit);
    }
    changed_.notify_all();
}

void FrameGate::setInterval(Clock::duration interval) {
    {
        const std::lock_guard lock(mutex_);
        interval_ = interval;
    }
    changed_.notify_all();
}

void FrameGate::look() {
    {
        // Whoever is between asking and waiting must not miss it.
        const std::lock_guard lock(mutex_);
    }
    changed_.notify_all();
}

}  // namespace eyrie::coordinator
