// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "tests/support/renderer_farm.h"

namespace eyrie::bench {

using Clock = std::chrono::steady_clock;

enum class Fault {
    Kill,       ///< SIGKILL; a new process starts 250 ms later
    BriefStop,  ///< SIGSTOP, SIGCONT after 0.05 to 1.5 s: mere lateness
    LongStop,   ///< SIGSTOP, SIGCONT after 4 s: it is taken for dead
};

/// What happened to one renderer, and when the coordinator noticed.
struct Event {
    Fault fault;
    Clock::time_point at;
    std::optional<Clock::time_point> dead;    ///< listed as dead
    std::optional<Clock::time_point> mended;  ///< continued, or started again
    std::optional<Clock::time_point> back;    ///< listed as ready after that
};

/// Renderer processes that come to grief.
class FaultyFarm {
public:
    struct Options {
        std::string program;  ///< path of `eyrie`
        fabric::Scene scene;
        std::string layout = "2D";
        int renderers = 3;
        unsigned seed = 1;
    };

    static absl::StatusOr<std::unique_ptr<FaultyFarm>> start(const Options& options);

    coordinator::FrameSource& frames() { return farm_->frames(); }

    /// True once all renderers draw.
    bool awaitAllReady(std::chrono::milliseconds limit) { return farm_->awaitAllReady(limit); }

    /// Does it to a renderer that is ready, chosen by chance. False, and nothing is done, while it
    /// would leave no other that is.
    bool inject(Fault fault);

    /// To be called often: continues and restarts processes when it is time, and notes what the
    /// coordinator says of them.
    void tend();

    /// Whether every renderer is back that something was done to.
    bool isWhole() const;

    const std::vector<Event>& events() const { return events_; }

private:
    struct Slot {
        std::optional<std::size_t> event;  ///< that it has not recovered from
        Clock::time_point mendAt;
    };

    explicit FaultyFarm(unsigned seed) : random_(seed) {}
    void tend(std::size_t slot, const coordinator::Status& status);
    Clock::duration lengthOf(Fault fault);

    std::mt19937 random_;
    std::unique_ptr<test::RendererFarm> farm_;
    std::vector<Slot> slots_;  ///< of the farm's renderers
    std::vector<Event> events_;
};

}  // namespace eyrie::bench
