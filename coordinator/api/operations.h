// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/api/workers.h"
#include "eyrie/v1/operation.pb.h"

namespace eyrie::api {

/// What takes longer than a call: begun by one, done by threads of its own, asked about and called
/// off by others. All functions may be called from any thread.
class Operations {
public:
    using Clock = std::chrono::steady_clock;

    struct Limits {
        std::size_t atOnce = 1;
        std::size_t waiting = 16;
        std::size_t ended = 200;  ///< that are remembered
    };

    /// Told the stage and how far that is, 0 to 1.
    using Progress = std::function<void(std::string_view stage, double fraction)>;
    /// Of what was made, for people, such as what was left out.
    using Notes = std::vector<std::string>;
    /// Ends soon, and leaves nothing, after `stop`.
    using Work =
        std::function<absl::StatusOr<Notes>(const Progress& progress, const std::stop_token& stop)>;

    struct Order {
        std::string id = {};  ///< empty: one is made
        v1::OperationKind kind = v1::OPERATION_KIND_UNSPECIFIED;
        std::string output = {};
        /// What was asked for: the same id is for the same only.
        std::string request = {};
        Work work = {};
    };

    /// Told of each operation that has ended, and how; calls nothing of Operations.
    using Ended = std::function<void(const v1::Operation& operation, const absl::Status& status)>;

    explicit Operations(const Limits& limits, std::function<Clock::time_point()> now = Clock::now,
                        Ended ended = {});
    /// Calls off all, and waits for their ends.
    ~Operations();
    Operations(const Operations&) = delete;
    Operations& operator=(const Operations&) = delete;

    /// That of `id`, begun with the same request. NotFound: there is none; AlreadyExists: the id is
    /// another request's.
    absl::StatusOr<v1::Operation> begun(std::string_view id, const std::string& request) const;

    /// The operation that does it, which one of that id and request may have been before. Errors:
    /// InvalidArgument (the id), AlreadyExists (the id is another request's), FailedPrecondition
    /// (its output is being made by another), ResourceExhausted (too many wait).
    absl::StatusOr<v1::Operation> begin(Order order);

    /// In the order in which they were begun.
    std::vector<v1::Operation> all() const;
    /// Errors of what follows: NotFound.
    absl::StatusOr<v1::Operation> find(std::string_view id) const;
    absl::StatusOr<v1::Operation> cancel(std::string_view id);
    absl::Status forget(std::string_view id);

private:
    struct Entry {
        v1::Operation told;
        std::string request;
        std::stop_source stop = {};
        Clock::time_point begun = {};
        Clock::time_point stageBegun = {};
        Clock::time_point ended = {};
    };
    using Shared = std::shared_ptr<Entry>;  ///< forgotten, it is still what its work tells

    v1::Operation toldOf(const Entry& entry) const;
    absl::StatusOr<v1::Operation> sameOf(std::string_view id, const std::string& request) const;
    absl::StatusOr<Shared> entryOf(std::string_view id) const;
    void carryOut(const Shared& entry, const Work& work);
    void note(Entry& entry, std::string_view stage, double fraction);
    void end(Entry& entry, const absl::Status& status);
    void dropOldest();

    const Limits limits_;
    const std::function<Clock::time_point()> now_;
    const Ended ended_;
    mutable std::mutex mutex_;  ///< guards what follows, and what the entries hold
    std::list<Shared> entries_;
    Workers workers_;
};

/// Whether an operation that is so has ended.
bool hasEnded(v1::OperationState state);

}  // namespace eyrie::api
