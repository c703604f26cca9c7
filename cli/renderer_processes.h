// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <absl/status/status.h>

#include "cli/cache_options.h"
#include "cli/temporary_folder.h"

namespace eyrie::cli {

struct RendererProcessesOptions {
    int count = 1;             ///< 1 to RendererProcesses::kMaxCount
    std::string coordinator;   ///< where they register
    std::vector<int> devices;  ///< EGL devices, taken in turn; empty: each takes the first it finds
    CacheOptions cache;
    TileDecoding decoding = TileDecoding::Auto;
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

    /// Whether each has failed before it ever worked, as without EGL. Each has then said why on
    /// standard error. Any thread.
    bool allFailed() const { return failed_ == options_.count; }

private:
    class Slot;
    void supervise(const std::stop_token& stop);

    const RendererProcessesOptions options_;
    const TemporaryFolder& sockets_;
    std::atomic<int> failed_{0};
    std::jthread thread_;  ///< starts the children: they end with it
};

}  // namespace eyrie::cli
