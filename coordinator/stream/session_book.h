// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/stream/statistics_feed.h"

namespace eyrie::stream {

class Session;

/// The sessions that have viewers, and what is drawn for them, for programs to see. All functions
/// may be called from any thread.
class SessionBook {
public:
    /// `readers` as StatisticsFeed has it.
    explicit SessionBook(std::size_t readers = 64) : statistics_(readers) {}

    /// What a session of that name goes by: its name, or, where it has none, one of its own.
    std::string idFor(const std::string& name);

    /// It is told of while it lives and has viewers.
    void add(const std::shared_ptr<Session>& session);

    /// In the order in which they began.
    std::vector<std::shared_ptr<Session>> all() const;
    /// Null: there is none.
    std::shared_ptr<Session> find(std::string_view id) const;

    StatisticsFeed& statistics() { return statistics_; }

private:
    mutable std::mutex mutex_;  ///< guards what follows
    std::uint64_t nameless_ = 0;
    std::vector<std::weak_ptr<Session>> sessions_;
    StatisticsFeed statistics_;
};

}  // namespace eyrie::stream
