// SPDX-License-Identifier: Apache-2.0
#include "tests/support/link_queue.h"

#include <algorithm>
#include <utility>

namespace eyrie::test {
namespace {

LinkQueue::Clock::duration timeOnLine(std::size_t bytes, const LinkQueue::Line& line) {
    if (line.bitsPerSecond <= 0)
        return {};
    const std::chrono::duration<double> time(8.0 * static_cast<double>(bytes) / line.bitsPerSecond);
    return std::chrono::duration_cast<LinkQueue::Clock::duration>(time);
}

}  // namespace

bool LinkQueue::put(Packet packet, const Line& line, Clock::time_point now) {
    send(line, now);
    if (waitingBytes_ + packet.size() > kQueueBytes)
        return false;
    waitingBytes_ += packet.size();
    waiting_.push_back({now, std::move(packet)});
    return true;
}

std::optional<LinkQueue::Packet> LinkQueue::take(const Line& line, Clock::time_point now) {
    send(line, now);
    if (underWay_.empty() || underWay_.front().arrives > now)
        return std::nullopt;
    Packet packet = std::move(underWay_.front().packet);
    underWay_.pop_front();
    return packet;
}

std::optional<LinkQueue::Clock::time_point> LinkQueue::next() const {
    std::optional<Clock::time_point> soonest;
    if (!underWay_.empty())
        soonest = underWay_.front().arrives;
    if (!waiting_.empty())
        soonest = soonest ? std::min(*soonest, lineFree_) : lineFree_;
    return soonest;
}

void LinkQueue::send(const Line& line, Clock::time_point now) {
    while (!waiting_.empty()) {
        Waiting& first = waiting_.front();
        const Clock::time_point start = std::max(first.came, lineFree_);
        if (start > now)
            return;
        lineFree_ = start + timeOnLine(first.packet.size(), line);
        waitingBytes_ -= first.packet.size();
        underWay_.push_back({lineFree_ + line.delay, std::move(first.packet)});
        waiting_.pop_front();
    }
}

}  // namespace eyrie::test
