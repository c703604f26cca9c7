// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <absl/status/status.h>

#include "cli/drawing_options.h"
#include "cli/temporary_folder.h"

namespace eyrie::cli {

struct RendererProcessesOptions {
    int count = 1;             ///< at first, 1 to RendererProcesses::kMaxCount
    std::string coordinator;   ///< where they register
    std::vector<int> devices;  ///< EGL devices, taken in turn; empty: each takes the first it finds
    DrawingOptions drawing;
};

/// Renderer processes of this machine's own: `eyrie renderer` as children that share its cores,
/// started again when they die. One that never worked is not started again.
class RendererProcesses {
public:
    static constexpr int kMaxCount = 64;

    /// How many renderers suit this machine: one a GPU; without, two, or one on a single core.
    static int suitableCount(const std::vector<int>& devices);

    /// Returns at once; the processes start on a thread of this object.
    explicit RendererProcesses(RendererProcessesOptions options, const TemporaryFolder& sockets);
    /// Ends them, within a second or so: one that still draws is killed.
    ~RendererProcesses();
    RendererProcesses(const RendererProcesses&) = delete;
    RendererProcesses& operator=(const RendererProcesses&) = delete;

    /// There are to be `count` of them, 1 to kMaxCount, from now on; returns at once. Those that
    /// are too many leave after a while in which they may be wanted again: they finish what they
    /// have. Any thread.
    void setCount(int count) { count_ = count; }

    /// Whether each has failed before it ever worked, as without EGL. Each has then said why on
    /// standard error. Any thread.
    bool allFailed() const { return allFailed_; }

private:
    class Slot;
    void supervise(const std::stop_token& stop);

    const RendererProcessesOptions options_;
    const TemporaryFolder& sockets_;
    std::atomic<int> count_;
    std::atomic<bool> allFailed_{false};
    std::jthread thread_;  ///< starts the children: they end with it
};

}  // namespace eyrie::cli
