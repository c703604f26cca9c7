// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "coordinator/stream/session.h"
#include "coordinator/stream/session_book.h"

namespace eyrie::stream {

/// Which session a viewer joins, and how.
struct Joining {
    std::string session = {};  ///< empty: one of its own
    Role role = Role::Lead;
    /// Otherwise it only watches where others are, and switches no layouts.
    bool mayControl = true;
    /// Who comes again under the same has the place and the lead of who came before, whose
    /// connection may not be known to have died yet. Empty: nobody's.
    std::string viewer = {};
};

/// What /ws?session=NAME&role=watch|lead&viewer=NAME asks for; `target` may have more fields.
/// Errors: InvalidArgument (no name of 1 to 64 letters, digits, ".", "-" and "_", another role, or
/// one of them twice).
absl::StatusOr<Joining> joiningOf(std::string_view target);

/// The sessions of one frame source: those with names are there while they have viewers. All
/// functions may be called from any thread.
class Sessions {
public:
    /// `frames` outlives this and all viewers. They are told of in `book`; null: nowhere.
    explicit Sessions(coordinator::FrameSource& frames, const SessionOptions& options = {},
                      std::shared_ptr<SessionBook> book = nullptr);

    struct Joined {
        std::shared_ptr<Session> session;
        std::shared_ptr<Seat> seat;
    };
    Joined join(const Joining& joining, std::function<void()> messageReady);
    void leave(const Joined& joined);

    coordinator::FrameSource& frames() { return frames_; }

private:
    std::shared_ptr<Session> begin(const std::string& name) const;

    coordinator::FrameSource& frames_;
    const std::shared_ptr<SessionBook> book_;
    const SessionOptions options_;
    std::mutex mutex_;                                     ///< guards the names
    std::map<std::string, std::weak_ptr<Session>> named_;  ///< those that have viewers
};

}  // namespace eyrie::stream
