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

Crowd::Place Crowd::seat(const std::string& address) {
    const std::lock_guard lock(taken_->mutex);
    std::size_t& here = taken_->viewersOf[address];
    if (taken_->viewers >= limits_.viewers ||
        (limits_.viewersPerAddress != 0 && here >= limits_.viewersPerAddress)) {
        if (here == 0)
            taken_->viewersOf.erase(address);
        return nullptr;
    }
    ++here;
    ++taken_->viewers;
    return {taken_.get(), [taken = taken_, address](void*) {
                const std::lock_guard guard(taken->mutex);
                --taken->viewers;
                if (--taken->viewersOf[address] == 0)
                    taken->viewersOf.erase(address);
            }};
}

}  // namespace eyrie::http
