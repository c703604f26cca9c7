// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/registry.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "fabric/log.h"

namespace eyrie::coordinator {

absl::StatusOr<std::string> Registry::add(const std::string& address,
                                          const fabric::DeviceInfo& device,
                                          std::shared_ptr<ChannelRenderer> renderer,
                                          Clock::time_point now, std::string node) {
    std::string id;
    {
        const std::lock_guard lock(mutex_);
        displace(address);
        const auto alive = std::count_if(records_.begin(), records_.end(),
                                         [](const Record& r) { return r.entry.isAlive(); });
        if (static_cast<std::size_t>(alive) >= options_.maxRenderers)
            return absl::ResourceExhaustedError(
                fmt::format("{} renderers are registered, which is the limit", alive));
        id = fmt::format("renderer-{}", nextId_++);
        records_.push_back({{id, address, device, std::move(renderer)}, now});
        records_.back().entry.node = std::move(node);
    }
    spdlog::info("{} registered at {}: {}", id, address, device.renderer);
    listeners_.notify();
    return id;
}

void Registry::displace(const std::string& address) {
    for (const Record& record : records_)
        if (record.entry.address == address && record.entry.isAlive())
            displaced_.push_back({record.entry.id, address});
    std::erase_if(records_, [&](const Record& r) { return r.entry.address == address; });
    if (displaced_.size() > options_.maxDisplaced)
        displaced_.pop_front();
}

void Registry::refuse(const std::string& address, const fabric::DeviceInfo& device,
                      std::string_view why, Clock::time_point now) {
    bool isKnown = false;  // one that is started again and again is told to the log once
    {
        const std::lock_guard lock(mutex_);
        const auto isThere = [&](const Record& r) { return r.entry.address == address; };
        const auto found = std::find_if(records_.begin(), records_.end(), isThere);
        if (found != records_.end() && found->entry.isAlive())
            return;
        isKnown = found != records_.end() && found->entry.presence == Presence::Refused &&
                  found->entry.why == why;
        std::erase_if(records_, isThere);
        records_.push_back(
            {{address, address, device, nullptr, Presence::Refused, std::string(why), now}, now});
        trimRefused();
    }
    if (!isKnown)
        spdlog::warn("refused a renderer at {}: {}", address, why);
    listeners_.notify();
}

/// The oldest goes.
void Registry::trimRefused() {
    const auto isRefused = [](const Record& r) { return r.entry.presence == Presence::Refused; };
    const auto refused = std::count_if(records_.begin(), records_.end(), isRefused);
    if (static_cast<std::size_t>(refused) > options_.maxRefused)
        records_.erase(std::find_if(records_.begin(), records_.end(), isRefused));
}

Registry::Record* Registry::findAlive(const std::string& id) {
    const auto found = std::find_if(records_.begin(), records_.end(), [&](const Record& r) {
        return r.entry.id == id && r.entry.isAlive();
    });
    return found != records_.end() ? &*found : nullptr;
}

absl::Status Registry::heartbeat(const std::string& id, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (const auto found = std::ranges::find(displaced_, id, &Displaced::id);
        found != displaced_.end())
        return absl::FailedPreconditionError(fmt::format(
            "another renderer has registered at {}; give each its own --listen", found->address));
    Record* record = findAlive(id);
    if (record == nullptr)
        return absl::NotFoundError(fmt::format("'{}' is not registered; register again", id));
    record->lastSeen = now;
    return absl::OkStatus();
}

absl::Status Registry::drain(const std::string& id, Clock::time_point now) {
    {
        const std::lock_guard lock(mutex_);
        Record* record = findAlive(id);
        if (record == nullptr)
            return absl::NotFoundError(fmt::format("'{}' is not registered any more", id));
        record->lastSeen = now;
        if (std::exchange(record->entry.presence, Presence::Draining) == Presence::Draining)
            return absl::OkStatus();
    }
    spdlog::info("{} leaves: it gets no new tasks", id);
    listeners_.notify();
    return absl::OkStatus();
}

void Registry::remove(const std::string& id) {
    {
        const std::lock_guard lock(mutex_);
        if (std::erase_if(records_, [&](const Record& r) { return r.entry.id == id; }) == 0)
            return;
    }
    spdlog::info("{} has left", id);
    listeners_.notify();
}

void Registry::markDead(const std::string& id, std::string_view why, Clock::time_point now) {
    {
        const std::lock_guard lock(mutex_);
        Record* record = findAlive(id);
        if (record == nullptr)
            return;
        record->entry.presence = Presence::Dead;
        record->entry.why = why;
        record->entry.since = now;
    }
    spdlog::warn("gave {} up: {}", id, why);
    listeners_.notify();
}

void Registry::forgive(Clock::time_point now) {
    const auto missed = now - std::exchange(lastLook_, now);
    if (missed > options_.heartbeatInterval)
        for (Record& record : records_) record.lastSeen = std::min(now, record.lastSeen + missed);
}

void Registry::expire(Clock::time_point now) {
    const auto silence = options_.heartbeatInterval * options_.missedHeartbeats;
    std::vector<std::string> silent;
    std::vector<std::string> cutOff;
    std::size_t forgotten = 0;
    {
        const std::lock_guard lock(mutex_);
        forgive(now);
        forgotten = std::erase_if(records_, [&](const Record& r) {
            return !r.entry.isAlive() && now - r.entry.since > options_.deadShownFor;
        });
        for (const auto& [entry, lastSeen] : records_)
            if (entry.isAlive() && entry.renderer && entry.renderer->hasLostConnection())
                cutOff.push_back(entry.id);
            else if (entry.isAlive() && now - lastSeen > silence)
                silent.push_back(entry.id);
    }
    for (const std::string& id : cutOff) markDead(id, "its connection has ended", now);
    for (const std::string& id : silent)
        markDead(id, fmt::format("no heartbeat for {} ms", silence.count()), now);
    if (forgotten != 0)
        listeners_.notify();
}

std::vector<Registry::Entry> Registry::entries() const {
    const std::lock_guard lock(mutex_);
    std::vector<Entry> entries;
    for (const Record& record : records_) entries.push_back(record.entry);
    return entries;
}

}  // namespace eyrie::coordinator
