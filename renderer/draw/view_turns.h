// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "fabric/channel_task.h"
#include "renderer/lod/channel.h"

namespace eyrie::draw {

/// The view that is drawn, among those that are drawn by turns: walls, eyes, parts, sessions.
struct ViewTurn {
    std::uint32_t view = 0;                      ///< its name
    std::span<const std::uint32_t> others = {};  ///< that will probably be drawn again; ascending

    bool concerns(std::uint32_t name) const {
        return name == view || std::ranges::binary_search(others, name);
    }
};

/// Tells views that are drawn by turns from one that moves. docs/decisions/0075-views-by-turns.md
///
/// A view goes on as what it may have become (lod::mayContinue), the nearest first; one that comes
/// back to where some view was lately is another. What has been drawn again after others takes
/// turns, until as many draws have passed twice: so a single view, wherever it jumps, is alone.
class ViewTurns {
public:
    /// The next to be drawn. A complete frame is drawn as if alone, and nobody expects it again.
    /// Valid until the next call.
    ViewTurn next(const lod::Channel& channel, fabric::Completeness completeness);
    /// As if nothing had been drawn.
    void forget();

private:
    static constexpr std::size_t kMost = 16;  ///< views, and draws looked back at
    /// More draws of others between two of a view tell nothing of when it comes again.
    static constexpr std::uint64_t kLongestRound = std::uint64_t{2} * kMost;

    struct Known {
        std::uint32_t name;
        lod::Channel channel;
        std::uint64_t drawn = 0;        ///< number of its last draw
        std::uint64_t othersDrawn = 0;  ///< between its last two turns; 0: it had one only
        bool isExpected = true;
    };

    Known* nearest(const lod::Channel& channel);
    bool hasBeenSeen(const lod::Channel& channel, const lod::Channel& last) const;
    Known& add(const lod::Channel& channel);

    std::uint64_t now_ = 0;
    std::uint32_t lastName_ = 0;
    std::vector<Known> known_;  ///< ascending by name
    std::deque<lod::Channel> recent_;
    std::vector<std::uint32_t> others_;  ///< of the last turn
};

/// A State for the view that is drawn and for each of the others, in the order of their names.
template <typename State>
class PerView {
public:
    /// Of the view that is drawn; a new one if it has none. Others that have none are left out;
    /// those of views that the turn does not concern are forgotten.
    State& of(const ViewTurn& turn) {
        std::erase_if(states_, [&](const auto& one) { return !turn.concerns(one.first); });
        return states_[turn.view];
    }
    const std::map<std::uint32_t, State>& all() const { return states_; }
    std::map<std::uint32_t, State>& all() { return states_; }

private:
    std::map<std::uint32_t, State> states_;
};

}  // namespace eyrie::draw
