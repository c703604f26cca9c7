// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <optional>

namespace eyrie::coordinator {

struct PatienceOptions {
    /// While nothing is known of any renderer: files may have to be read.
    std::chrono::milliseconds first{10'000};
    std::chrono::milliseconds least{100};
    int timesMedian = 3;
};

/// How long a renderer may take for a channel before another one is asked as well. Being late is no
/// fault: the first answer counts. Learned by kinds of frames (scene, size, error asked for), of
/// which the latest few are remembered: viewers that take turns do not make each other forget.
class Patience {
public:
    explicit Patience(const PatienceOptions& options) : options_(options) {}

    /// timesMedian of the recent channels' median, at least `least`; none while nothing is known of
    /// the kind.
    std::optional<std::chrono::milliseconds> limit(std::uint64_t kind) const;

    /// A channel that was given so long took so long. More counts as what was given: a renderer
    /// that stood still for once is not slow, and one that has become slower is soon known to be.
    void record(std::uint64_t kind, std::chrono::milliseconds given,
                std::chrono::milliseconds taken);

private:
    static constexpr std::size_t kRemembered = 15;
    static constexpr std::size_t kKinds = 8;

    struct Recent {
        std::uint64_t kind;
        std::deque<std::chrono::milliseconds> times;
    };

    PatienceOptions options_;
    std::list<Recent> kinds_;  ///< the one recorded last comes first
};

}  // namespace eyrie::coordinator
