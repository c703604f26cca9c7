// SPDX-License-Identifier: Apache-2.0
#include "cli/stop_signal.h"

#include <condition_variable>
#include <csignal>
#include <ctime>
#include <mutex>

namespace eyrie::cli {
namespace {

sigset_t stopSignals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
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
    const sigset_t set = stopSignals();
    const timespec shortly{0, 20'000'000};  // how soon the destructor is noticed
    while (!ending.stop_requested()) {
        const int signal = sigtimedwait(&set, nullptr, &shortly);
        if (signal < 0 || source_.request_stop())
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
