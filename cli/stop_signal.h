// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <thread>

namespace eyrie::cli {

/// Undoes StopSignal's hold on the signals in a child process, between fork and exec.
void unblockStopSignals();

/// Turns SIGINT, SIGTERM and, unless the process ignores it, SIGHUP into a request to stop. One
/// that comes over a second later ends the process as it usually would, should stopping hang;
/// sooner ones are echoes of the first, such as timeout(1) sends. Make it before any other thread:
/// threads inherit that they leave the signals alone.
class StopSignal {
public:
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal&) = delete;
    StopSignal& operator=(const StopSignal&) = delete;

    std::stop_token token() const { return source_.get_token(); }
    /// Asks for the same from within.
    void request() { source_.request_stop(); }
    /// Returns once a stop was requested.
    void wait() const;

private:
    void listen(const std::stop_token& ending);

    std::stop_source source_;
    std::jthread thread_;
};

}  // namespace eyrie::cli
