// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>

namespace eyrie::coordinator {

struct PatienceOptions {
    std::chrono::milliseconds first{10'000};  ///< while nothing is known: files may have to be read
    std::chrono::milliseconds least{500};
    int timesMedian = 3;
};

/// How long a channel may take before another renderer is asked as well. Being late is no fault:
/// the first answer counts.
class Patience {
public:
    explicit Patience(const PatienceOptions& options) : options_(options) {}

    /// timesMedian of the recent channels' median, at least `least`; `first` without any.
    std::chrono::milliseconds limit() const;

    void record(std::chrono::milliseconds taken);

    /// Frames of another kind (scene, size, error asked for) come next.
    void forget() { recent_.clear(); }

private:
    static constexpr std::size_t kRemembered = 15;

    PatienceOptions options_;
    std::deque<std::chrono::milliseconds> recent_;
};

}  // namespace eyrie::coordinator
