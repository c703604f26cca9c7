// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace eyrie::test {

/// A network of two hosts: this process, in a network namespace of its own, and another namespace.
/// Between them a thread carries packets from one TUN device to the other, and loses, delays or
/// blocks them as told, which does not take the kernel's netem. Needs root and /dev/net/tun.
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

    /// Runs `job` in the other namespace, where the processes that it starts are, too; waits for
    /// it. They live as long as the link at most.
    void runThere(const std::function<void()>& job);

private:
    using Clock = std::chrono::steady_clock;
    struct Packet {
        Clock::time_point due;
        int to;
        std::vector<char> bytes;
    };

    void live(const std::stop_token& stop);
    void carry(const std::stop_token& stop);
    void take(int from, int to);
    void deliver();

    int here_ = -1;
    int there_ = -1;
    std::atomic<double> loss_{0};
    std::atomic<std::chrono::milliseconds> delay_{};
    std::mt19937 random_{1};      ///< of the carrier
    std::deque<Packet> packets_;  ///< on their way; the carrier's
    std::mutex mutex_;            ///< guards what follows
    std::condition_variable_any changed_;
    const std::function<void()>* job_ = nullptr;
    bool isThere_ = false;
    std::string error_;
    std::jthread host_;  ///< in the other namespace
    std::jthread carrier_;
};

}  // namespace eyrie::test
