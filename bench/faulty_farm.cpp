// SPDX-License-Identifier: Apache-2.0
#include "bench/faulty_farm.h"

#include <algorithm>
#include <csignal>

#include "fabric/status.h"

namespace eyrie::bench {
namespace {

using coordinator::RendererCondition;
using std::chrono::milliseconds;

/// As long as `eyrie serve` waits before it starts a renderer again.
constexpr milliseconds kRestartPause{250};
constexpr milliseconds kLongStop{4000};

}  // namespace

absl::StatusOr<std::unique_ptr<FaultyFarm>> FaultyFarm::start(const Options& options) {
    std::unique_ptr<FaultyFarm> farm(new FaultyFarm(options.seed));
    coordinator::CoordinatorOptions coordinator;
    coordinator.layout = options.layout;
    coordinator.scene = options.scene;
    ASSIGN_OR_RETURN(farm->farm_, test::RendererFarm::start(options.program, options.renderers,
                                                            std::move(coordinator)));
    farm->slots_.resize(static_cast<std::size_t>(options.renderers));
    return farm;
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
        if (!slots_[i].event && farm_->conditionOf(i, status) == RendererCondition::Ready)
            sound.push_back(i);
    if (sound.size() < 2)
        return false;
    const std::size_t index =
        sound[std::uniform_int_distribution<std::size_t>(0, sound.size() - 1)(random_)];
    Slot& slot = slots_[index];
    slot.event = events_.size();
    const Clock::time_point now = Clock::now();
    farm_->renderer(index).send(fault == Fault::Kill ? SIGKILL : SIGSTOP);
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
    const auto condition = farm_->conditionOf(index, status);
    if (!event.dead && !event.mended && condition == RendererCondition::Dead)
        event.dead = now;
    if (!event.mended && now >= slot.mendAt) {
        event.mended = now;
        if (event.fault == Fault::Kill)
            farm_->restart(index);
        else
            farm_->renderer(index).send(SIGCONT);
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
