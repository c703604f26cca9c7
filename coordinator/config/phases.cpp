// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/phases.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

/// Of a frame that is drawn: its number has this remainder.
struct Turn {
    std::int64_t period = 1;
    std::int64_t phase = 0;

    bool has(std::int64_t frame) const { return frame % period == phase; }
    auto operator<=>(const Turn&) const = default;
};
/// Of a compound and those that it is part of: it draws where all have the frame.
using Turns = std::set<Turn>;

/// What draws a destination for one eye.
struct Drawn {
    Place place;            ///< of the first compound that is the destination's
    std::set<Turns> turns;  ///< of those that draw; one without turns draws always
};

bool isDrawn(const Drawn& drawn, std::int64_t frame) {
    return std::ranges::any_of(drawn.turns, [frame](const Turns& turns) {
        return std::ranges::all_of(turns, [frame](const Turn& turn) { return turn.has(frame); });
    });
}

/// After how many frames all is as before.
std::int64_t cycleOf(const Drawn& drawn) {
    std::int64_t cycle = 1;
    for (const Turns& turns : drawn.turns)
        for (const Turn& turn : turns)
            if (cycle < kMostFramesLookedAt)
                cycle = std::lcm(cycle, std::min(turn.period, kMostFramesLookedAt));
    return std::min(cycle, kMostFramesLookedAt);
}

/// Whether there was anything to say.
bool warn(const Drawn& drawn, Findings& findings) {
    if (drawn.turns.empty() || drawn.turns.contains(Turns{}))
        return false;
    const std::int64_t cycle = cycleOf(drawn);
    std::int64_t missing = 0;
    std::int64_t first = 0;
    for (std::int64_t frame = cycle - 1; frame >= 0; --frame)
        if (!isDrawn(drawn, frame)) {
            ++missing;
            first = frame;
        }
    if (missing > 0)
        findings.warning(drawn.place,
                         fmt::format("nothing draws the picture in {} of {} frames, such as that "
                                     "of phase {}: it is background then",
                                     missing, cycle, first));
    return missing > 0;
}

Turns turnsOf(const std::vector<Turn>& levels) {
    Turns turns;
    for (const Turn& each : levels)
        if (each.period > 1)
            turns.insert(each);
    return turns;
}

/// Of each destination that compounds are of.
std::vector<std::optional<Drawn>> drawnFor(bool Eyes::*eye, const ResolvedConfiguration& resolved) {
    std::vector<std::optional<Drawn>> all(resolved.destinations.size());
    std::vector<Turn> levels;
    for (const ResolvedCompound& each : resolved.compounds) {
        levels.resize(static_cast<std::size_t>(each.depth));
        levels.push_back({each.period, each.phase});
        if (!each.destination)
            continue;
        std::optional<Drawn>& drawn = all[*each.destination];
        if (!drawn)
            drawn = Drawn{each.place(), {}};
        if (each.tasks.draw && each.eyes.*eye)
            drawn->turns.insert(turnsOf(levels));
    }
    return all;
}

}  // namespace

void warnOfMissingPhases(const ResolvedConfiguration& resolved, Findings& findings) {
    std::vector<bool> isSaid(resolved.destinations.size(), false);  // for one eye is enough
    for (bool Eyes::*const eye : {&Eyes::cyclop, &Eyes::left, &Eyes::right}) {
        const std::vector<std::optional<Drawn>> drawn = drawnFor(eye, resolved);
        for (std::size_t i = 0; i < drawn.size(); ++i)
            if (drawn[i] && !isSaid[i])
                isSaid[i] = warn(*drawn[i], findings);
    }
}

}  // namespace eyrie::config
