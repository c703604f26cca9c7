// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/crew.h"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

namespace eyrie::coordinator {
namespace {

std::string textOf(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

bool saysGone(const absl::Status& status) {
    switch (status.code()) {
        case absl::StatusCode::kUnavailable:
        case absl::StatusCode::kDeadlineExceeded:
        case absl::StatusCode::kFailedPrecondition:
        case absl::StatusCode::kInternal:
        case absl::StatusCode::kUnknown:
        case absl::StatusCode::kUnimplemented:
            return true;
        default:
            return false;
    }
}

}  // namespace

Crew::Crew(Registry& registry, std::chrono::milliseconds openTimeout, std::function<void()> changed)
    : registry_(registry), openTimeout_(openTimeout), changed_(std::move(changed)) {
    subscription_ = registry_.listeners().add([this] {
        follow();
        changed_();
    });
    follow();
}

Crew::~Crew() {
    registry_.listeners().remove(subscription_);
    std::vector<std::shared_ptr<Member>> members;
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
        members = std::move(retired_);
        for (Seat& seat : seats_) members.push_back(std::move(seat.member));
        seats_.clear();
    }
    for (const std::shared_ptr<Member>& member : members) member->retire();
}

void Crew::setScene(fabric::Scene scene) {
    {
        const std::lock_guard lock(mutex_);
        scene_ = std::make_shared<const fabric::Scene>(std::move(scene));
        ++revision_;
        hasInfo_ = false;
        info_ = {};
        for (Seat& seat : seats_) openIn(seat);
    }
    changed_();
}

std::vector<std::shared_ptr<Member>> Crew::ready(std::uint64_t revision) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<Member>> members;
    for (const Seat& seat : seats_)
        if (revision == revision_ && isReady(seat))
            members.push_back(seat.member);
    return members;
}

void Crew::noteFailure(const std::string& id, const absl::Status& status) {
    if (saysGone(status))
        registry_.markDead(id, textOf(status), Registry::Clock::now());
}

bool Crew::isReady(const Seat& seat) const {
    return hasInfo_ && seat.member->openRevision() == revision_;
}

Crew::State Crew::state() const {
    const std::lock_guard lock(mutex_);
    State state{scene_, info_, revision_, 0, 0, {}};
    for (const Seat& seat : seats_) {
        if (isReady(seat))
            ++state.ready;
        else if (seat.openError.empty())
            ++state.opening;
        else
            state.openError = seat.openError;
    }
    return state;
}

void Crew::follow() {
    std::vector<std::shared_ptr<Member>> ended;  // destroyed without the lock
    const std::lock_guard lock(mutex_);
    if (closing_)
        return;
    const std::vector<Registry::Entry> entries = registry_.entries();
    retireMissing(entries);
    seatNew(entries);
    const auto done = std::stable_partition(retired_.begin(), retired_.end(),
                                            [](const auto& member) { return !member->hasEnded(); });
    ended.assign(std::make_move_iterator(done), std::make_move_iterator(retired_.end()));
    retired_.erase(done, retired_.end());
}

void Crew::retireMissing(const std::vector<Registry::Entry>& entries) {
    std::erase_if(seats_, [&](Seat& seat) {
        const bool alive = std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
            return entry.alive && entry.id == seat.member->id();
        });
        if (alive)
            return false;
        seat.member->retire();
        retired_.push_back(std::move(seat.member));
        return true;
    });
}

void Crew::seatNew(const std::vector<Registry::Entry>& entries) {
    for (const Registry::Entry& entry : entries) {
        const bool seated = std::any_of(seats_.begin(), seats_.end(), [&](const Seat& seat) {
            return seat.member->id() == entry.id;
        });
        if (!entry.alive || seated)
            continue;
        seats_.push_back(
            {std::make_shared<Member>(entry.id, entry.device, entry.renderer), std::string()});
        openIn(seats_.back());
    }
}

void Crew::openIn(Seat& seat) {
    seat.openError.clear();
    if (scene_->objects.empty())
        return;
    seat.member->open(
        scene_, revision_, openTimeout_,
        [this, id = seat.member->id(), revision = revision_](
            const absl::StatusOr<fabric::SceneInfo>& info) { noteOpened(id, revision, info); });
}

void Crew::noteOpened(const std::string& id, std::uint64_t revision,
                      const absl::StatusOr<fabric::SceneInfo>& info) {
    {
        const std::lock_guard lock(mutex_);
        if (closing_ || revision != revision_)
            return;
        if (info.ok() && !hasInfo_) {
            info_ = *info;
            hasInfo_ = true;
        }
        for (Seat& seat : seats_)
            if (!info.ok() && seat.member->id() == id)
                seat.openError = textOf(info.status());
    }
    if (info.ok()) {
        spdlog::info("{} has the scene open", id);
    } else {
        spdlog::warn("{} cannot open the scene: {}", id, textOf(info.status()));
        noteFailure(id, info.status());
    }
    changed_();
}

}  // namespace eyrie::coordinator
