// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

#include <absl/status/status.h>

namespace eyrie::import {

/// Told how far a long import is: the stage's name ("reading", "building tree") and its own
/// fraction, 0 to 1, ascending within a stage. Called by one thread at a time, at most a few
/// hundred times per import; must not throw.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// How a caller watches an import and calls it off. The default does neither.
struct ImportControl {
    Progress progress;
    std::stop_token stop;  ///< polled; the import then returns Cancelled, leaving no file behind

    void report(std::string_view stage, double fraction) const {
        if (progress)
            progress(stage, fraction);
    }
    /// Cancelled when a stop was requested, otherwise OK.
    absl::Status check() const {
        return stop.stop_requested() ? absl::CancelledError("import cancelled") : absl::OkStatus();
    }
};

}  // namespace eyrie::import
