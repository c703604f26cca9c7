// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/crew.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "fabric/log.h"
#include "fabric/shown_name.h"

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

/// Its data could not be had or took too long: heartbeats tell whether it is alive.
bool mayOpenLater(const absl::Status& status) {
    return absl::IsAborted(status) || absl::IsDeadlineExceeded(status);
}

/// "dem (data/dem.eyt) has 123 bytes and sum 00…, with the others 124 bytes and sum 01…"; empty
/// where both have the same files.
std::string differenceOf(const fabric::Scene& scene, const std::vector<fabric::DataFile>& found,
                         const std::vector<fabric::DataFile>& expected) {
    if (found.size() != expected.size())
        return fmt::format("it names {} files, the others {}", found.size(), expected.size());
    std::string difference;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] == expected[i] || i >= scene.objects.size())
            continue;
        difference += fmt::format(
            "{}{} ({}) has {} bytes and sum {:016x} there, {} bytes and sum {:016x} with the "
            "others",
            difference.empty() ? "" : "; ", scene.objects[i].name,
            fabric::shownName(scene.objects[i].path), found[i].bytes, found[i].checksum,
            expected[i].bytes, expected[i].checksum);
    }
    return difference;
}

std::chrono::system_clock::time_point onTheWall(Member::Clock::time_point time) {
    const auto ago = Member::Clock::now() - time;
    return std::chrono::system_clock::now() -
           std::chrono::duration_cast<std::chrono::system_clock::duration>(ago);
}

}  // namespace

Crew::Crew(Registry& registry, const CrewOptions& options, std::function<void()> changed)
    : registry_(registry), options_(options), changed_(std::move(changed)) {
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
        openInAll();
    }
    changed_();
}

/// A new revision: parts of pictures that were begun with another scene, or other data, are never
/// put together with parts of this one.
void Crew::openInAll() {
    ++revision_;
    hasInfo_ = false;
    info_ = {};
    for (Seat& seat : seats_) openIn(seat);
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

/// There is nothing to open in a scene without objects.
bool Crew::isReady(const Seat& seat) const {
    return (seat.opened == revision_ || scene_->objects.empty()) && !seat.drains;
}

bool Crew::anyOpened() const {
    return std::any_of(seats_.begin(), seats_.end(),
                       [this](const Seat& seat) { return seat.opened == revision_; });
}

Crew::State Crew::state() const {
    const std::lock_guard lock(mutex_);
    State state{scene_, info_, revision_, 0, 0, {}};
    for (const Seat& seat : seats_) {
        if (isReady(seat))
            ++state.ready;
        else if (!seat.openError.ok())
            state.openError = textOf(seat.openError);
        else if (!seat.drains)
            ++state.opening;
    }
    return state;
}

std::string Crew::addressOf(const std::string& id) const {
    const std::vector<Registry::Entry> entries = registry_.entries();
    const auto found = std::ranges::find(entries, id, &Registry::Entry::id);
    return found == entries.end() ? std::string() : found->address;
}

std::vector<RendererStatus> Crew::renderers() const {
    using Presence = Registry::Presence;
    const std::lock_guard lock(mutex_);
    std::vector<RendererStatus> renderers;
    for (const Registry::Entry& entry : registry_.entries()) {
        RendererStatus& status = renderers.emplace_back();
        status.id = entry.id;
        status.address = entry.address;
        status.device = entry.device;
        if (entry.presence == Presence::Alive)
            describe(entry.id, status);
        else if (entry.presence == Presence::Draining)
            status.condition = RendererCondition::Draining;
        else
            status = {entry.id,
                      entry.address,
                      entry.device,
                      entry.presence == Presence::Dead ? RendererCondition::Dead
                                                       : RendererCondition::Refused,
                      entry.why,
                      onTheWall(entry.since)};
    }
    return renderers;
}

void Crew::describe(const std::string& id, RendererStatus& status) const {
    status.condition =
        scene_->objects.empty() ? RendererCondition::Ready : RendererCondition::Opening;
    for (const Seat& seat : seats_) {
        if (seat.member->id() != id)
            continue;
        if (isReady(seat))
            status.condition =
                seat.member->isLate() ? RendererCondition::Late : RendererCondition::Ready;
        if (!seat.openError.ok()) {
            status.condition = RendererCondition::Refused;
            status.why = textOf(seat.openError);
            status.code = seat.openError.code();
            status.since = onTheWall(seat.since);
        }
    }
}

void Crew::follow() {
    std::vector<std::shared_ptr<Member>> ended;  // destroyed without the lock
    const std::lock_guard lock(mutex_);
    if (closing_)
        return;
    const std::vector<Registry::Entry> entries = registry_.entries();
    retireMissing(entries);
    seatNew(entries);
    if (hasInfo_ && !anyOpened() &&
        std::any_of(seats_.begin(), seats_.end(), [](const Seat& s) { return s.hasOtherData; }))
        openInAll();
    const auto done = std::stable_partition(retired_.begin(), retired_.end(),
                                            [](const auto& member) { return !member->hasEnded(); });
    ended.assign(std::make_move_iterator(done), std::make_move_iterator(retired_.end()));
    retired_.erase(done, retired_.end());
}

void Crew::retireMissing(const std::vector<Registry::Entry>& entries) {
    std::erase_if(seats_, [&](Seat& seat) {
        const auto entry = std::find_if(entries.begin(), entries.end(), [&](const auto& one) {
            return one.isAlive() && one.id == seat.member->id();
        });
        if (entry != entries.end()) {
            if (entry->presence == Registry::Presence::Draining && !seat.drains)
                drain(seat);
            return false;
        }
        seat.member->retire();
        retired_.push_back(std::move(seat.member));
        return true;
    });
}

/// It leaves when it has done what it was given. Opening a scene is not worth waiting for.
void Crew::drain(Seat& seat) {
    const bool mayBeOpening = seat.opened != revision_;
    seat.drains = true;
    seat.member->leave([this, id = seat.member->id()] { registry_.remove(id); });
    if (mayBeOpening)
        seat.member->retire();
}

void Crew::seatNew(const std::vector<Registry::Entry>& entries) {
    for (const Registry::Entry& entry : entries) {
        const bool seated = std::any_of(seats_.begin(), seats_.end(), [&](const Seat& seat) {
            return seat.member->id() == entry.id;
        });
        if (!entry.isAlive() || seated)
            continue;
        Seat& seat = seats_.emplace_back();
        seat.member = std::make_shared<Member>(entry.id, entry.device, entry.renderer,
                                               options_.patience, entry.node);
        openIn(seat);
        if (entry.presence == Registry::Presence::Draining)
            drain(seat);
    }
}

void Crew::openAgain(Member::Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    for (Seat& seat : seats_)
        if (!closing_ && !seat.drains && seat.retry.takeTurn(now))
            askToOpen(seat);
}

void Crew::openIn(Seat& seat) {
    seat.openError = absl::OkStatus();
    seat.retry = {};
    seat.hasOtherData = false;
    seat.opened = 0;
    if (!scene_->objects.empty() && !seat.drains)
        askToOpen(seat);
}

void Crew::askToOpen(Seat& seat) {
    seat.member->open(
        scene_, revision_, options_.openTimeout,
        [this, id = seat.member->id(), revision = revision_](
            const absl::StatusOr<fabric::SceneInfo>& info) { noteOpened(id, revision, info); });
}

void Crew::noteOpened(const std::string& id, std::uint64_t revision,
                      const absl::StatusOr<fabric::SceneInfo>& info) {
    absl::Status status = info.status();
    bool isNews = true;  // one that is told again and again is told to the log once
    {
        const std::lock_guard lock(mutex_);
        if (closing_ || revision != revision_)
            return;
        const auto seat = std::find_if(seats_.begin(), seats_.end(),
                                       [&](const Seat& one) { return one.member->id() == id; });
        if (seat == seats_.end())
            return;
        if (info.ok())
            status = seatOpened(*seat, *info);
        if (!status.ok())
            isNews = noteOpenError(*seat, status);
    }
    if (!isNews)
        return;
    if (status.ok()) {
        spdlog::info("{} has the scene open", id);
    } else {
        spdlog::warn("{} cannot take part: {}", id, textOf(status));
        if (!info.ok() && !mayOpenLater(status))
            noteFailure(id, status);
    }
    changed_();
}

/// Whether it is another than before.
bool Crew::noteOpenError(Seat& seat, const absl::Status& error) {
    const Member::Clock::time_point now = Member::Clock::now();
    if (mayOpenLater(error))
        seat.retry.noteFailure(now);
    if (seat.openError == error)
        return false;
    seat.openError = error;
    seat.since = now;
    return true;
}

/// Where nobody is left that has the data which earlier pictures show, these are the data.
absl::Status Crew::seatOpened(Seat& seat, const fabric::SceneInfo& info) {
    const std::string difference =
        hasInfo_ ? differenceOf(*scene_, info.files, info_.files) : std::string();
    if (difference.empty()) {
        if (!std::exchange(hasInfo_, true))
            info_ = info;
        seat.opened = revision_;
        seat.openError = absl::OkStatus();
    } else if (anyOpened()) {
        seat.hasOtherData = true;
        return absl::FailedPreconditionError(
            fmt::format("{} has other data than the others: {}; give all renderers the same files "
                        "or, where a file was replaced, set the scene again (PUT /api/v1/scene)",
                        seat.member->id(), difference));
    } else {
        openInAll();
    }
    return absl::OkStatus();
}

}  // namespace eyrie::coordinator
