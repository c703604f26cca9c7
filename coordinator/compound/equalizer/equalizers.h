// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/compound/equalizer/balancer.h"
#include "coordinator/compound/equalizer/frame_facts.h"
#include "coordinator/config/configuration.h"
#include "coordinator/config/equalizer_tuning.h"

namespace eyrie::equalizer {

using Tuning = config::EqualizerTuning;

/// An equalizer at work.
struct EqualizerState {
    /// As written or, where it has none, kind and compound: "load.left" or, by position, "load.2".
    std::string name;
    std::size_t compound = 0;  ///< position in config::ResolvedConfiguration::compounds
    config::Equalizer settings;
    bool isOn = true;
    bool isFrozen = false;
    Report report;
};

/// All equalizers of a configuration at work: before each frame they change its compounds, after it
/// they learn what it took. No threads, no clock: callers take turns, and times come as numbers.
///
/// Changed are viewport and range of the children of a compound with a load, tree or view
/// equalizer, zoom (DFR), outputtiles and inputtiles (tile), and frames' zoom (monitor).
/// A framerate equalizer says how often frames may begin. A child without a share gets a viewport
/// or range of no size.
class Equalizers {
public:
    /// `written` is the configuration as its file has it; what is switched off returns to that.
    explicit Equalizers(const config::Configuration& written);

    /// Copies have learned the same so far; each goes on by itself.
    Equalizers(const Equalizers& other);
    Equalizers& operator=(const Equalizers&) = delete;
    ~Equalizers() = default;

    /// `live` has the compounds of `written`, perhaps as an earlier call left them.
    void apply(config::Configuration& live, const FrameFacts& facts);

    /// For one of the last frames applied, in any order; older ones than the newest recorded, and
    /// those that were not applied, tell nothing. Whatever the numbers, shares stay shares.
    void record(const FrameTimes& times);

    /// `name` as in states(), or its position there. Errors: NotFound, naming those there are;
    /// InvalidArgument, naming the setting. Then nothing has changed.
    absl::Status tune(std::string_view name, const Tuning& tuning);
    absl::Status tune(std::size_t position, const Tuning& tuning);

    /// The position in states() of what is named so. Errors: NotFound, naming those there are.
    absl::StatusOr<std::size_t> find(std::string_view name) const;

    /// How long after a frame of those applied last has begun the next is to begin; 0: at any time.
    double intervalMilliseconds() const;

    /// In preorder of their compounds, of each as written.
    std::vector<EqualizerState> states() const;

private:
    struct Entry {
        std::string name;
        std::size_t position = 0;
        config::Equalizer settings;
        bool isOn = true;
        bool isFrozen = false;
        std::unique_ptr<Balancer> balancer;
    };
    void add(const config::Compound& written, std::size_t& position);

    std::shared_ptr<const Work> work_;  ///< balancers refer to it
    std::vector<Entry> entries_;
    std::deque<PlannedFrame> planned_;  ///< the last ones, oldest first
    std::optional<std::uint64_t> recorded_;
};

}  // namespace eyrie::equalizer
