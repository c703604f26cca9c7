// SPDX-License-Identifier: Apache-2.0
#include "cli/renderer_processes.h"

#include <algorithm>
#include <deque>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "cli/child_process.h"
#include "cli/log.h"
#include "cli/restart_policy.h"
#include "fabric/log.h"

namespace eyrie::cli {
namespace {

constexpr std::chrono::milliseconds kPollInterval{50};
constexpr std::chrono::milliseconds kStopGrace{1000};
/// Who looks at another layout for a moment has nothing to load again.
constexpr std::chrono::seconds kSurplusStays{3};
/// For what it has in hand; others draw what it has not finished then.
constexpr std::chrono::seconds kLeaveGrace{10};
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

    /// Starts where it is wanted, as one of `count`; leaves when it has not been for a while;
    /// notices the end, and starts again.
    void tend(Clock::time_point now, bool isWanted, int count) {
        if (failed_)
            return;
        if (isWanted)
            wantedUntil_ = now + kSurplusStays;
        if (process_)
            watch(now);
        else if (isWanted && now >= nextStart_)
            start(now, count);
    }

    bool hasFailed() const { return failed_; }
    std::optional<ChildProcess>& process() { return process_; }

private:
    void start(Clock::time_point now, int count) {
        ++generation_;
        std::vector<std::string> arguments = {
            "renderer", "--coordinator", options_.coordinator, "--listen",
            sockets_.socket(fmt::format("renderer-{}-{}", number_, generation_)),
            "--exit-with-coordinator",
            // Only their own coordinator reaches them, and its scenes are the user's.
            "--allow-url", "any",
            // EYRIE_DATA is the coordinator's folder, and files are where that has them.
            "--data", "",
            // EYRIE_TOKEN_FILE and EYRIE_TLS_... are of the coordinator's doors to others.
            "--token-file", "", "--tls-cert", "", "--tls-key", "", "--tls-ca", "", "--tls-name", "",
            "--quiet"};
        for (std::string& argument : argumentsOf(options_.drawing))
            arguments.push_back(std::move(argument));
        for (std::string& argument : logArguments()) arguments.push_back(std::move(argument));
        if (!options_.devices.empty()) {
            const auto index = static_cast<std::size_t>(number_) % options_.devices.size();
            arguments.insert(arguments.end(),
                             {"--device", std::to_string(options_.devices[index])});
        }
        auto process = ChildProcess::start(arguments, {threadLimit(count)});
        if (!process.ok()) {
            const auto message = process.status().message();
            spdlog::error("renderer {}: {}", number_ + 1,
                          std::string_view(message.data(), message.size()));
            failed_ = true;
            return;
        }
        process_ = *std::move(process);
        started_ = now;
    }

    void watch(Clock::time_point now) {
        if (now >= wantedUntil_ && !leaving_) {
            leaving_ = now;
            process_->terminate();
        }
        if (leaving_ && now - *leaving_ >= kLeaveGrace) {
            process_->stop(std::chrono::milliseconds(0));
            process_.reset();
            leaving_.reset();
        } else if (const auto end = process_->poll()) {
            ended(*end, now);
        }
    }

    void ended(const ChildProcess::End& end, Clock::time_point now) {
        process_.reset();
        if (std::exchange(leaving_, std::nullopt))
            return;
        if (generation_ == 1 && !end.crashed && now - started_ < kProbation) {
            failed_ = true;
            return;
        }
        nextStart_ = policy_.ended(started_, now);
        const auto pause = std::chrono::duration_cast<std::chrono::milliseconds>(nextStart_ - now);
        spdlog::warn("renderer {} ended ({}); it starts again in {:.2f} s", number_ + 1, end.text(),
                     static_cast<double>(pause.count()) / 1000);
    }

    /// llvmpipe takes every core unless told; several renderers would then fight over them.
    static std::string threadLimit(int count) {
        return fmt::format("LP_NUM_THREADS={}", std::max(1, cores() / count));
    }

    const int number_;
    const RendererProcessesOptions& options_;
    const TemporaryFolder& sockets_;
    std::optional<ChildProcess> process_;
    RestartPolicy policy_;
    Clock::time_point started_{};
    Clock::time_point nextStart_{};
    Clock::time_point wantedUntil_{};
    std::optional<Clock::time_point> leaving_;  ///< since when, once it was told to
    int generation_ = 0;
    bool failed_ = false;
};

int RendererProcesses::suitableCount(const std::vector<int>& devices) {
    return devices.empty() ? std::min(2, cores()) : static_cast<int>(devices.size());
}

RendererProcesses::RendererProcesses(RendererProcessesOptions options,
                                     const TemporaryFolder& sockets)
    : options_(std::move(options)), sockets_(sockets), count_(options_.count) {
    thread_ = std::jthread([this](const std::stop_token& stop) { supervise(stop); });
}

RendererProcesses::~RendererProcesses() = default;

void RendererProcesses::supervise(const std::stop_token& stop) {
    std::deque<Slot> slots;
    while (!stop.stop_requested()) {
        const int count = count_;
        while (std::ssize(slots) < count)
            slots.emplace_back(static_cast<int>(slots.size()), options_, sockets_);
        int missing = count;  // the first that can work are wanted
        for (Slot& slot : slots) {
            slot.tend(Slot::Clock::now(), missing > 0, count);
            missing -= slot.hasFailed() ? 0 : 1;
        }
        allFailed_ = std::ranges::all_of(slots, &Slot::hasFailed);
        std::this_thread::sleep_for(kPollInterval);
    }
    for (Slot& slot : slots)  // all at once, and all within the same time
        if (slot.process())
            slot.process()->terminate();
    const Slot::Clock::time_point deadline = Slot::Clock::now() + kStopGrace;
    for (Slot& slot : slots)
        if (slot.process())
            slot.process()->stop(std::max(
                std::chrono::milliseconds(0),
                std::chrono::ceil<std::chrono::milliseconds>(deadline - Slot::Clock::now())));
}

}  // namespace eyrie::cli
