// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/operations.h"

#include <algorithm>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "coordinator/stream/viewer_messages.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

constexpr std::size_t kMaxIdBytes = 64;
constexpr std::size_t kMaxNotes = 20;
/// Before that, how long a stage takes is a guess.
constexpr double kSettledSeconds = 0.3;

absl::Status checkId(std::string_view id) {
    const bool isId =
        !id.empty() && id.size() <= kMaxIdBytes && std::ranges::all_of(id, [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                   c == '-' || c == '_';
        });
    if (isId)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("request_id is '{}'; it must be 1 to {} of a-z, A-Z, 0-9, '-' and '_'",
                    id.substr(0, kMaxIdBytes), kMaxIdBytes));
}

std::string newId() {
    std::random_device random;
    return fmt::format("{:08x}{:08x}", random(), random());
}

double seconds(Operations::Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

void setNotes(const Operations::Notes& notes, v1::Operation& told) {
    const std::size_t first = notes.size() <= kMaxNotes ? notes.size() : kMaxNotes - 1;
    for (std::size_t i = 0; i < first; ++i) told.add_notes(stream::sanitised(notes[i]));
    if (first < notes.size())
        told.add_notes(
            fmt::format("and {} more; `eyrie import` tells them all", notes.size() - first));
}

}  // namespace

bool hasEnded(v1::OperationState state) {
    return state != v1::OPERATION_STATE_WAITING && state != v1::OPERATION_STATE_RUNNING;
}

Operations::Operations(const Limits& limits, std::function<Clock::time_point()> now, Ended ended)
    : limits_(limits),
      now_(std::move(now)),
      ended_(std::move(ended)),
      workers_(limits.atOnce, limits.waiting) {}

Operations::~Operations() {
    {
        const std::lock_guard lock(mutex_);
        for (const Shared& entry : entries_) entry->stop.request_stop();
    }
    workers_.stop();
}

absl::StatusOr<v1::Operation> Operations::begin(Order order) {
    if (order.id.empty())
        order.id = newId();
    RETURN_IF_ERROR(checkId(order.id));
    const std::lock_guard lock(mutex_);
    if (absl::StatusOr<v1::Operation> same = sameOf(order.id, order.request);
        !absl::IsNotFound(same.status()))
        return same;
    for (const Shared& other : entries_)
        if (other->told.output() == order.output && !hasEnded(other->told.state()))
            return absl::FailedPreconditionError(
                fmt::format("output '{}' is being made by the operation '{}'; wait for its end",
                            order.output, other->told.id()));
    const auto entry = std::make_shared<Entry>();
    entry->told.set_id(std::move(order.id));
    entry->told.set_kind(order.kind);
    entry->told.set_state(v1::OPERATION_STATE_WAITING);
    entry->told.set_output(std::move(order.output));
    entry->request = std::move(order.request);
    if (!workers_.post([this, entry, work = std::move(order.work)] { carryOut(entry, work); },
                       entry.get()))
        return absl::ResourceExhaustedError(fmt::format(
            "{} operations wait already; try again when some have ended", limits_.waiting));
    entries_.push_back(entry);
    return toldOf(*entry);
}

absl::StatusOr<v1::Operation> Operations::begun(std::string_view id,
                                                const std::string& request) const {
    const std::lock_guard lock(mutex_);
    return sameOf(id, request);
}

std::vector<v1::Operation> Operations::all() const {
    const std::lock_guard lock(mutex_);
    std::vector<v1::Operation> told;
    for (const Shared& entry : entries_) told.push_back(toldOf(*entry));
    return told;
}

absl::StatusOr<v1::Operation> Operations::find(std::string_view id) const {
    const std::lock_guard lock(mutex_);
    ASSIGN_OR_RETURN(const Shared entry, entryOf(id));
    return toldOf(*entry);
}

absl::StatusOr<v1::Operation> Operations::cancel(std::string_view id) {
    Shared entry;
    {
        const std::lock_guard lock(mutex_);
        ASSIGN_OR_RETURN(entry, entryOf(id));
        // One that nobody has begun with need not wait until somebody does.
        if (entry->told.state() == v1::OPERATION_STATE_WAITING) {
            workers_.withdraw(entry.get());
            end(*entry, absl::CancelledError(""));
        }
    }
    entry->stop.request_stop();
    const std::lock_guard lock(mutex_);
    return toldOf(*entry);
}

absl::Status Operations::forget(std::string_view id) {
    RETURN_IF_ERROR(cancel(id).status());
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [&](const Shared& entry) { return entry->told.id() == id; });
    return absl::OkStatus();
}

absl::StatusOr<v1::Operation> Operations::sameOf(std::string_view id,
                                                 const std::string& request) const {
    ASSIGN_OR_RETURN(const Shared entry, entryOf(id));
    if (entry->request == request)
        return toldOf(*entry);
    return absl::AlreadyExistsError(
        fmt::format("request_id '{}' was given with another request before; choose a new one", id));
}

absl::StatusOr<Operations::Shared> Operations::entryOf(std::string_view id) const {
    for (const Shared& entry : entries_)
        if (entry->told.id() == id)
            return entry;
    return absl::NotFoundError(fmt::format("there is no operation '{}'; it may have been forgotten",
                                           stream::sanitised(id.substr(0, kMaxIdBytes))));
}

v1::Operation Operations::toldOf(const Entry& entry) const {
    v1::Operation told = entry.told;
    if (told.state() == v1::OPERATION_STATE_WAITING || entry.begun == Clock::time_point())
        return told;
    const Clock::time_point now = hasEnded(told.state()) ? entry.ended : now_();
    told.set_seconds(seconds(now - entry.begun));
    const double inStage = seconds(now - entry.stageBegun);
    const double done = told.stage_progress();
    if (told.state() == v1::OPERATION_STATE_RUNNING && done > 0 && inStage >= kSettledSeconds)
        told.set_stage_seconds_left(inStage * (1 - done) / done);
    return told;
}

void Operations::carryOut(const Shared& entry, const Work& work) {
    {
        const std::lock_guard lock(mutex_);
        if (hasEnded(entry->told.state()))
            return;
        entry->told.set_state(v1::OPERATION_STATE_RUNNING);
        entry->begun = entry->stageBegun = now_();
    }
    const std::stop_token stop = entry->stop.get_token();
    const absl::StatusOr<Notes> notes =
        stop.stop_requested()
            ? absl::CancelledError("")
            : work([&](std::string_view stage, double fraction) { note(*entry, stage, fraction); },
                   stop);
    const std::lock_guard lock(mutex_);
    if (notes.ok())
        setNotes(*notes, entry->told);
    end(*entry, notes.status());
}

void Operations::note(Entry& entry, std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (entry.told.stage() != stage) {
        entry.told.set_stage(stream::sanitised(stage));
        entry.stageBegun = now_();
    }
    entry.told.set_stage_progress(fraction >= 0 ? std::min(fraction, 1.0) : 0.0);
}

void Operations::end(Entry& entry, const absl::Status& status) {
    entry.ended = now_();
    entry.told.clear_stage();
    entry.told.clear_stage_progress();
    if (status.ok()) {
        entry.told.set_state(v1::OPERATION_STATE_DONE);
    } else if (absl::IsCancelled(status)) {
        entry.told.set_state(v1::OPERATION_STATE_CANCELLED);
    } else {
        entry.told.set_state(v1::OPERATION_STATE_FAILED);
        entry.told.set_problem(
            stream::sanitised({status.message().data(), status.message().size()}));
    }
    if (ended_)
        ended_(entry.told, status);
    dropOldest();
}

void Operations::dropOldest() {
    const auto isOver = [](const Shared& entry) { return hasEnded(entry->told.state()); };
    auto over = static_cast<std::size_t>(std::ranges::count_if(entries_, isOver));
    for (auto at = entries_.begin(); over > limits_.ended && at != entries_.end();) {
        if (isOver(*at)) {
            at = entries_.erase(at);
            --over;
        } else {
            ++at;
        }
    }
}

}  // namespace eyrie::api
