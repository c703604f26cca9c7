// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace eyrie::test {

/// One direction of a link: a line that takes a packet at a time, a drop-tail queue before it, as a
/// router's, and the way behind it. Packets come out in the order in which they went in.
///
/// What happens depends on the times given alone, not on when it is asked about: who is late to ask
/// makes the line no slower. Times never go back. Not thread-safe.
class LinkQueue {
public:
    using Clock = std::chrono::steady_clock;
    using Packet = std::vector<char>;

    /// What waits for the line has room here, in bytes of packets; more is lost.
    static constexpr std::size_t kQueueBytes = 256 * 1024;

    struct Line {
        double bitsPerSecond = 0;  ///< 0: packets take no time, and none waits
        Clock::duration delay{};   ///< of the way, besides
    };

    /// A packet came at `now`. False: the queue was full, and it is lost.
    bool put(Packet packet, const Line& line, Clock::time_point now);

    /// The next packet that has arrived by `now`. A packet takes the line as it is told when it is
    /// its turn: changes are for what still waits.
    std::optional<Packet> take(const Line& line, Clock::time_point now);

    /// When take() has something to do again; absent: when a packet has come.
    std::optional<Clock::time_point> next() const;

private:
    struct Waiting {
        Clock::time_point came;
        Packet packet;
    };
    struct UnderWay {
        Clock::time_point arrives;
        Packet packet;
    };

    void send(const Line& line, Clock::time_point now);

    std::deque<Waiting> waiting_;
    std::size_t waitingBytes_ = 0;
    Clock::time_point lineFree_{};
    std::deque<UnderWay> underWay_;
};

}  // namespace eyrie::test
