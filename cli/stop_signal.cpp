// SPDX-License-Identifier: Apache-2.0
#include "cli/stop_signal.h"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <ctime>
#include <mutex>
#include <optional>

namespace eyrie::cli {
namespace {

constexpr std::chrono::seconds kEchoes{1};

/// nohup, for one, starts what is to outlive its terminal.
bool outlivesItsTerminal() {
    struct sigaction atHangup {};
    sigaction(SIGHUP, nullptr, &atHangup);
    return atHangup.sa_handler == SIG_IGN;
}

sigset_t stopSignals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    if (!outlivesItsTerminal())
        sigaddset(&set, SIGHUP);
    return set;
}

/// Threads inherit it: only sigtimedwait sees the signals from now on.
void blockStopSignals() {
    const sigset_t set = stopSignals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

}  // namespace

void unblockStopSignals() {
    const sigset_t set = stopSignals();
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

StopSignal::StopSignal() {
    blockStopSignals();
    thread_ = std::jthread([this](const std::stop_token& ending) { listen(ending); });
}

void StopSignal::listen(const std::stop_token& ending) {
    using Clock = std::chrono::steady_clock;
    const sigset_t set = stopSignals();
    const timespec shortly{0, 20'000'000};  // how soon the destructor is noticed
    std::optional<Clock::time_point> first;
    while (!ending.stop_requested()) {
        const int signal = sigtimedwait(&set, nullptr, &shortly);
        if (signal < 0)
            continue;
        source_.request_stop();
        if (!first)
            first = Clock::now();
        if (Clock::now() - *first < kEchoes)
            continue;
        std::signal(signal, SIG_DFL);
        unblockStopSignals();
        std::raise(signal);
    }
}

StopSignal::~StopSignal() = default;

void StopSignal::wait() const {
    std::mutex mutex;
    std::condition_variable_any changed;
    std::unique_lock lock(mutex);
    changed.wait(lock, source_.get_token(), [] { return false; });
}

}  // namespace eyrie::cli
