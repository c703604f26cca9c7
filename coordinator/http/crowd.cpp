// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/crowd.h"

#include <algorithm>
#include <utility>

namespace eyrie::http {

void Crowd::Waiting::end() {
    if (queue_ == nullptr)
        return;
    queue_->erase(at_);
    queue_ = nullptr;
}

Crowd::Crowd(const CrowdLimits& limits) : limits_(limits), taken_(std::make_shared<Taken>()) {}

Crowd::Place Crowd::enter() {
    if (isFull() && !dropOne())
        return nullptr;
    const std::lock_guard lock(taken_->mutex);
    ++taken_->connections;
    return {taken_.get(), [taken = taken_](void*) {
                const std::lock_guard guard(taken->mutex);
                --taken->connections;
            }};
}

bool Crowd::isFull() const {
    const std::lock_guard lock(taken_->mutex);
    return taken_->connections >= limits_.connections;
}

bool Crowd::dropOne() {
    std::map<std::string_view, std::size_t> counts;
    for (const Waiting::Entry& entry : waiting_) ++counts[entry.address];
    const auto most =
        std::max_element(counts.begin(), counts.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == counts.end())
        return false;
    const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const auto& entry) {
        return entry.address == most->first;
    });
    const std::function<void()> drop = std::move(found->drop);
    drop();  // and so it waits no more
    return true;
}

void Crowd::await(Waiting& waiting, const std::string& address, std::function<void()> drop) {
    waiting.end();
    waiting_.push_back({address, std::move(drop)});
    waiting.queue_ = &waiting_;
    waiting.at_ = std::prev(waiting_.end());
}

bool Crowd::Count::isFull(std::size_t most, std::size_t mostOfOne,
                          const std::string& address) const {
    const auto here = of.find(address);
    return all >= most || (mostOfOne != 0 && here != of.end() && here->second >= mostOfOne);
}

void Crowd::Count::leave(const std::string& address) {
    --all;
    if (--of[address] == 0)
        of.erase(address);
}

Crowd::Place Crowd::take(Count Taken::*count, const std::string& address) const {
    ++(taken_.get()->*count).all;
    ++(taken_.get()->*count).of[address];
    return {taken_.get(), [taken = taken_, count, address](void*) {
                const std::lock_guard guard(taken->mutex);
                (taken.get()->*count).leave(address);
            }};
}

absl::StatusOr<Crowd::Place> Crowd::seat(const std::string& address, const std::string& session) {
    // Before the lock is taken: the last who holds a place takes it, too.
    std::erase_if(named_, [](const auto& known) { return known.second.expired(); });
    Place joined;
    if (const auto known = named_.find(session); known != named_.end())
        joined = known->second.lock();
    const std::lock_guard lock(taken_->mutex);
    if (taken_->viewers.isFull(limits_.viewers, limits_.viewersPerAddress, address))
        return absl::ResourceExhaustedError("too many viewers; close some, or try again later");
    if (joined == nullptr &&
        taken_->sessions.isFull(limits_.sessions, limits_.sessionsPerAddress, address))
        return absl::ResourceExhaustedError(
            "too many sessions; close another window of the page, join another's session, or try "
            "again later");
    if (joined == nullptr) {
        joined = take(&Taken::sessions, address);
        if (!session.empty())
            named_[session] = joined;
    }
    return std::make_shared<std::pair<Place, Place>>(take(&Taken::viewers, address),
                                                     std::move(joined));
}

}  // namespace eyrie::http
