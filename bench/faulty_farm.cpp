// SPDX-License-Identifier: Apache-2.0
#include "bench/faulty_farm.h"

#include <algorithm>
#include <csignal>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::bench {
namespace {

using coordinator::RendererCondition;
using std::chrono::milliseconds;

/// As long as `eyrie serve` waits before it starts a renderer again.
constexpr milliseconds kRestartPause{250};
constexpr milliseconds kLongStop{4000};

std::optional<RendererCondition> conditionAt(const coordinator::Status& status,
                                             const std::string& address) {
    for (const coordinator::RendererStatus& renderer : status.renderers)
        if (renderer.address == address)
            return renderer.condition;
    return std::nullopt;
}

}  // namespace

absl::StatusOr<std::unique_ptr<FaultyFarm>> FaultyFarm::start(const Options& options) {
    std::unique_ptr<FaultyFarm> farm(new FaultyFarm(options));
    ASSIGN_OR_RETURN(farm->coordinator_, coordinator::Coordinator::start(
                                             {.grpcAddresses = {"unix:" + farm->folder_.path("c")},
                                              .layout = options.layout,
                                              .scene = options.scene}));
    farm->slots_.resize(static_cast<std::size_t>(options.renderers));
    for (std::size_t i = 0; i < farm->slots_.size(); ++i) farm->launch(i);
    return farm;
}

void FaultyFarm::launch(std::size_t index) {
    Slot& slot = slots_[index];
    slot.address =
        fmt::format("unix:{}", folder_.path(fmt::format("r{}-{}", index, slot.generation++)));
    slot.process = std::make_unique<test::Process>(
        std::vector<std::string>{options_.program, "renderer", "--coordinator",
                                 "unix:" + folder_.path("c"), "--listen", slot.address, "--quiet"},
        std::vector<std::string>{"LP_NUM_THREADS=1"});
}

bool FaultyFarm::awaitAllReady(milliseconds limit) {
    return test::eventually(limit, [this] {
        const coordinator::Status status = frames().status();
        return std::all_of(slots_.begin(), slots_.end(), [&](const Slot& slot) {
            return conditionAt(status, slot.address) == RendererCondition::Ready;
        });
    });
}

Clock::duration FaultyFarm::lengthOf(Fault fault) {
    if (fault == Fault::Kill)
        return kRestartPause;
    if (fault == Fault::LongStop)
        return kLongStop;
    return milliseconds(std::uniform_int_distribution<int>(50, 1500)(random_));
}

bool FaultyFarm::inject(Fault fault) {
    const coordinator::Status status = frames().status();
    std::vector<std::size_t> sound;
    for (std::size_t i = 0; i < slots_.size(); ++i)
        if (!slots_[i].event && conditionAt(status, slots_[i].address) == RendererCondition::Ready)
            sound.push_back(i);
    if (sound.size() < 2)
        return false;
    Slot& slot =
        slots_[sound[std::uniform_int_distribution<std::size_t>(0, sound.size() - 1)(random_)]];
    slot.event = events_.size();
    const Clock::time_point now = Clock::now();
    slot.process->send(fault == Fault::Kill ? SIGKILL : SIGSTOP);
    slot.mendAt = now + lengthOf(fault);
    events_.push_back({fault, now, {}, {}, {}});
    return true;
}

void FaultyFarm::tend() {
    const coordinator::Status status = frames().status();
    for (std::size_t i = 0; i < slots_.size(); ++i)
        if (slots_[i].event)
            tend(i, status);
}

void FaultyFarm::tend(std::size_t index, const coordinator::Status& status) {
    Slot& slot = slots_[index];
    Event& event = events_[*slot.event];
    const Clock::time_point now = Clock::now();
    const auto condition = conditionAt(status, slot.address);
    if (!event.dead && !event.mended && condition == RendererCondition::Dead)
        event.dead = now;
    if (!event.mended && now >= slot.mendAt) {
        event.mended = now;
        if (event.fault == Fault::Kill)
            launch(index);
        else
            slot.process->send(SIGCONT);
    } else if (event.mended && condition == RendererCondition::Ready) {
        event.back = now;
        slot.event.reset();
    }
}

bool FaultyFarm::isWhole() const {
    return std::none_of(slots_.begin(), slots_.end(),
                        [](const Slot& slot) { return slot.event.has_value(); });
}

}  // namespace eyrie::bench
