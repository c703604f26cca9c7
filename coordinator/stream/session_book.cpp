// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/session_book.h"

#include <fmt/format.h>

#include "coordinator/stream/session.h"

namespace eyrie::stream {

std::string SessionBook::idFor(const std::string& name) {
    if (!name.empty())
        return name;
    const std::lock_guard lock(mutex_);
    return fmt::format("@{}", ++nameless_);  // no name has an @ in it
}

void SessionBook::add(const std::shared_ptr<Session>& session) {
    const std::lock_guard lock(mutex_);
    std::erase_if(sessions_, [](const auto& known) { return known.expired(); });
    sessions_.push_back(session);
}

std::vector<std::shared_ptr<Session>> SessionBook::all() const {
    std::vector<std::shared_ptr<Session>> living;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& known : sessions_)
            if (auto session = known.lock())
                living.push_back(std::move(session));
    }
    // Without the lock: the last reference may be this one, and its end takes a while.
    std::erase_if(living, [](const auto& session) { return !session->hasViewers(); });
    return living;
}

std::shared_ptr<Session> SessionBook::find(std::string_view id) const {
    for (const std::shared_ptr<Session>& session : all())
        if (session->id() == id)
            return session;
    return nullptr;
}

}  // namespace eyrie::stream
