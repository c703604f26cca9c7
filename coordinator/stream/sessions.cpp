// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/sessions.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "fabric/log.h"

namespace eyrie::stream {
namespace {

constexpr std::size_t kMaxNameLength = 64;
constexpr std::string_view kNameRule = "1 to 64 letters, digits, \".\", \"-\" and \"_\"";

bool isName(std::string_view text) {
    return !text.empty() && text.size() <= kMaxNameLength && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '.' || c == '-' || c == '_';
    });
}

}  // namespace

absl::StatusOr<Joining> joiningOf(std::string_view target) {
    Joining joining;
    const std::size_t mark = target.find('?');
    std::string_view query = mark == target.npos ? "" : target.substr(mark + 1);
    std::set<std::string_view> given;
    while (!query.empty()) {
        const std::string_view field = query.substr(0, query.find('&'));
        query.remove_prefix(std::min(query.size(), field.size() + 1));
        const std::string_view name = field.substr(0, field.find('='));
        if ((name == "session" || name == "role" || name == "viewer") && !given.insert(name).second)
            return absl::InvalidArgumentError(
                fmt::format("{} is in the query twice; give it once", name));
        if (field.starts_with("session=")) {
            joining.session = field.substr(8);
            if (!isName(joining.session))
                return absl::InvalidArgumentError(fmt::format("a session's name is {}", kNameRule));
        } else if (field.starts_with("viewer=")) {
            joining.viewer = field.substr(7);
            if (!isName(joining.viewer))
                return absl::InvalidArgumentError(fmt::format("a viewer's name is {}", kNameRule));
        } else if (field == "role=watch") {
            joining.role = Role::Watch;
        } else if (field.starts_with("role=") && field != "role=lead") {
            return absl::InvalidArgumentError("a viewer's role is \"lead\" or \"watch\"");
        }
    }
    return joining;
}

Sessions::Sessions(coordinator::FrameSource& frames, const SessionOptions& options,
                   std::shared_ptr<SessionBook> book)
    : frames_(frames), book_(std::move(book)), options_([&] {
          SessionOptions own = options;
          own.statistics = book_ == nullptr ? nullptr : &book_->statistics();
          return own;
      }()) {}

std::shared_ptr<Session> Sessions::begin(const std::string& name) const {
    if (book_ == nullptr)
        return std::make_shared<Session>(frames_, name, options_);
    auto session = std::make_shared<Session>(frames_, name, options_, book_->idFor(name));
    book_->add(session);
    return session;
}

Sessions::Joined Sessions::join(const Joining& joining, std::function<void()> messageReady) {
    if (joining.session.empty()) {
        // Alone, there is nobody else to lead.
        auto own = begin("");
        return {own, own->join(Role::Lead, joining.mayControl, "", std::move(messageReady))};
    }
    const std::lock_guard lock(mutex_);
    std::weak_ptr<Session>& known = named_[joining.session];
    std::shared_ptr<Session> session = known.lock();
    if (session == nullptr || session->isClosed()) {
        session = begin(joining.session);
        known = session;
    }
    const Role role = joining.mayControl ? joining.role : Role::Watch;
    return {session,
            session->join(role, joining.mayControl, joining.viewer, std::move(messageReady))};
}

void Sessions::leave(const Joined& joined) {
    const std::lock_guard lock(mutex_);
    const std::string& name = joined.session->name();
    if (!joined.session->leave(joined.seat) || name.empty())
        return;
    // Another may have begun under the name of one that was closed.
    if (const auto known = named_.find(name);
        known != named_.end() && known->second.lock() == joined.session)
        named_.erase(known);
    const SessionCounts counts = joined.session->counts();
    spdlog::info("session {} has ended: {} frames drawn, {} pictures encoded, {} sent", name,
                 counts.drawn, counts.encoded, counts.given);
}

}  // namespace eyrie::stream
