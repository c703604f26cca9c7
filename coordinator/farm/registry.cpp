// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/registry.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace eyrie::coordinator {

absl::StatusOr<std::string> Registry::add(const std::string& address,
                                          const fabric::DeviceInfo& device,
                                          std::shared_ptr<ChannelRenderer> renderer,
                                          Clock::time_point now) {
    std::string id;
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(records_, [&](const Record& r) { return r.entry.address == address; });
        const auto alive = std::count_if(records_.begin(), records_.end(),
                                         [](const Record& r) { return r.entry.alive; });
        if (static_cast<std::size_t>(alive) >= options_.maxRenderers)
            return absl::ResourceExhaustedError(
                fmt::format("{} renderers are registered, which is the limit", alive));
        id = fmt::format("renderer-{}", nextId_++);
        records_.push_back({{id, address, device, std::move(renderer), true}, now});
    }
    spdlog::info("{} registered at {}: {}", id, address, device.renderer);
    listeners_.notify();
    return id;
}

Registry::Record* Registry::find(const std::string& id) {
    const auto found = std::find_if(records_.begin(), records_.end(),
                                    [&](const Record& r) { return r.entry.id == id; });
    return found != records_.end() && found->entry.alive ? &*found : nullptr;
}

absl::Status Registry::heartbeat(const std::string& id, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    Record* record = find(id);
    if (record == nullptr)
        return absl::NotFoundError(fmt::format("'{}' is not registered; register again", id));
    record->lastSeen = now;
    return absl::OkStatus();
}

void Registry::markDead(const std::string& id, std::string_view why, Clock::time_point now) {
    {
        const std::lock_guard lock(mutex_);
        Record* record = find(id);
        if (record == nullptr)
            return;
        record->entry.alive = false;
        record->lastSeen = now;
    }
    spdlog::warn("gave {} up: {}", id, why);
    listeners_.notify();
}

void Registry::expire(Clock::time_point now) {
    const auto silence = options_.heartbeatInterval * options_.missedHeartbeats;
    std::vector<std::string> silent;
    std::size_t forgotten = 0;
    {
        const std::lock_guard lock(mutex_);
        forgotten = std::erase_if(records_, [&](const Record& r) {
            return !r.entry.alive && now - r.lastSeen > options_.deadShownFor;
        });
        for (const Record& record : records_)
            if (record.entry.alive && now - record.lastSeen > silence)
                silent.push_back(record.entry.id);
    }
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
