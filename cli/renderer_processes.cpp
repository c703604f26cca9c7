// SPDX-License-Identifier: Apache-2.0
#include "cli/renderer_processes.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "cli/child_process.h"
#include "cli/decode_names.h"
#include "cli/log.h"
#include "cli/restart_policy.h"
#include "fabric/log.h"

namespace eyrie::cli {
namespace {

constexpr std::chrono::milliseconds kPollInterval{50};
constexpr std::chrono::milliseconds kStopGrace{1000};
/// A renderer that ends by itself within this has not worked: it says why and ends again.
constexpr std::chrono::seconds kProbation{5};

int cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

}  // namespace

/// One renderer: the process it is now, or when it starts again.
class RendererProcesses::Slot {
public:
    using Clock = RestartPolicy::Clock;

    Slot(int number, const RendererProcessesOptions& options, const TemporaryFolder& sockets)
        : number_(number), options_(options), sockets_(sockets) {}

    /// Starts, notices the end, starts again. True the moment it has failed for good.
    bool tend(Clock::time_point now) {
        if (failed_)
            return false;
        if (!process_)
            return now >= nextStart_ && !start(now);
        if (const auto end = process_->poll())
            return ended(*end, now);
        return false;
    }

    std::optional<ChildProcess>& process() { return process_; }

private:
    bool start(Clock::time_point now) {
        ++generation_;
        std::vector<std::string> arguments = {
            "renderer", "--coordinator", options_.coordinator, "--listen",
            sockets_.socket(fmt::format("renderer-{}-{}", number_, generation_)),
            "--exit-with-coordinator",
            // Only their own coordinator reaches them, and its scenes are the user's.
            "--allow-url", "any", "--cache-size", options_.cache.size, "--decode",
            nameOf(options_.decoding), "--quiet"};
        if (!options_.cache.folder.empty())
            arguments.insert(arguments.end(), {"--cache", options_.cache.folder});
        for (std::string& argument : logArguments()) arguments.push_back(std::move(argument));
        if (!options_.devices.empty()) {
            const auto index = static_cast<std::size_t>(number_) % options_.devices.size();
            arguments.insert(arguments.end(),
                             {"--device", std::to_string(options_.devices[index])});
        }
        auto process = ChildProcess::start(arguments, {threadLimit()});
        if (!process.ok()) {
            const auto message = process.status().message();
            spdlog::error("renderer {}: {}", number_ + 1,
                          std::string_view(message.data(), message.size()));
            failed_ = true;
            return false;
        }
        process_ = *std::move(process);
        started_ = now;
        return true;
    }

    bool ended(const ChildProcess::End& end, Clock::time_point now) {
        process_.reset();
        if (generation_ == 1 && !end.crashed && now - started_ < kProbation) {
            failed_ = true;
            return true;
        }
        nextStart_ = policy_.ended(started_, now);
        const auto pause = std::chrono::duration_cast<std::chrono::milliseconds>(nextStart_ - now);
        spdlog::warn("renderer {} ended ({}); it starts again in {:.2f} s", number_ + 1, end.text(),
                     static_cast<double>(pause.count()) / 1000);
        return false;
    }

    /// llvmpipe takes every core unless told; several renderers would then fight over them.
    std::string threadLimit() const {
        return fmt::format("LP_NUM_THREADS={}", std::max(1, cores() / options_.count));
    }

    const int number_;
    const RendererProcessesOptions& options_;
    const TemporaryFolder& sockets_;
    std::optional<ChildProcess> process_;
    RestartPolicy policy_;
    Clock::time_point started_{};
    Clock::time_point nextStart_{};
    int generation_ = 0;
    bool failed_ = false;
};

int RendererProcesses::suitableCount(const std::vector<int>& devices) {
    return devices.empty() ? std::min(2, cores()) : static_cast<int>(devices.size());
}

RendererProcesses::RendererProcesses(RendererProcessesOptions options,
                                     const TemporaryFolder& sockets)
    : options_(std::move(options)), sockets_(sockets) {
    thread_ = std::jthread([this](const std::stop_token& stop) { supervise(stop); });
}

RendererProcesses::~RendererProcesses() = default;

void RendererProcesses::supervise(const std::stop_token& stop) {
    std::vector<Slot> slots;
    slots.reserve(static_cast<std::size_t>(options_.count));
    for (int i = 0; i < options_.count; ++i) slots.emplace_back(i, options_, sockets_);
    while (!stop.stop_requested()) {
        for (Slot& slot : slots)
            if (slot.tend(Slot::Clock::now()))
                ++failed_;
        std::this_thread::sleep_for(kPollInterval);
    }
    for (Slot& slot : slots)  // all at once, then each is waited for
        if (slot.process())
            slot.process()->terminate();
    for (Slot& slot : slots)
        if (slot.process())
            slot.process()->stop(kStopGrace);
}

}  // namespace eyrie::cli
