// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <thread>

#include "tests/support/link_queue.h"

namespace eyrie::test {

/// A network of two hosts: this process, in a network namespace of its own, and another namespace.
/// Between them a thread carries packets of 1500 bytes at most from one TUN device to the other,
/// and loses, delays, queues or blocks them as told, which does not take the kernel's netem. Needs
/// root and /dev/net/tun.
///
/// To be made before other threads: those there are already stay in the old namespace.
class LossyLink {
public:
    static constexpr const char* kHere = "10.203.7.1";
    static constexpr const char* kThere = "10.203.7.2";

    /// Throws std::runtime_error that says what is missing.
    LossyLink();
    ~LossyLink();
    LossyLink(const LossyLink&) = delete;
    LossyLink& operator=(const LossyLink&) = delete;

    /// Of packets, 0 to 1, either way; 1 parts the hosts.
    void lose(double share) { loss_ = share; }
    /// Of each packet, either way.
    void delay(std::chrono::milliseconds time) { delay_ = time; }
    /// Each way by itself, counting packets with their IP headers; what comes faster waits in a
    /// LinkQueue, and is lost when that is full. 0: as fast as it comes.
    void limit(double bitsPerSecond) { bitsPerSecond_ = bitsPerSecond; }

    /// Runs `job` in the other namespace, where the processes that it starts are, too; waits for
    /// it. They live as long as the link at most.
    void runThere(const std::function<void()>& job);

private:
    using Clock = LinkQueue::Clock;

    void live(const std::stop_token& stop);
    void carry(const std::stop_token& stop);
    void wait(Clock::time_point until) const;
    void take(int from, LinkQueue& queue);
    void deliver(LinkQueue& queue, int to) const;
    LinkQueue::Line line() const { return {bitsPerSecond_, delay_.load()}; }

    int here_ = -1;
    int there_ = -1;
    std::atomic<double> loss_{0};
    std::atomic<std::chrono::milliseconds> delay_{};
    std::atomic<double> bitsPerSecond_{0};
    std::mt19937 random_{1};  ///< of the carrier, as are the queues
    LinkQueue toHere_;
    LinkQueue toThere_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable_any changed_;
    const std::function<void()>* job_ = nullptr;
    bool isThere_ = false;
    std::string error_;
    std::jthread host_;  ///< in the other namespace
    std::jthread carrier_;
};

}  // namespace eyrie::test
