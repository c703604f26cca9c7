// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/view_turns.h"

#include <utility>

#include <glm/geometric.hpp>

namespace eyrie::draw {
namespace {

/// What is nearer than this share of the way from where a view was has been there before.
constexpr double kComesBack = 0.1;

/// From one channel's camera to another's.
struct Way {
    double metres;
    double turned;  ///< between the cameras' axes

    Way(const lod::Channel& from, const lod::Channel& to)
        : metres(glm::distance(from.view.eye, to.view.eye)), turned(0) {
        for (int axis = 0; axis < 3; ++axis)
            turned += glm::distance(from.view.viewFromWorldRotation[axis],
                                    to.view.viewFromWorldRotation[axis]);
    }
    bool isNone() const { return metres == 0 && turned == 0; }
    bool isShorterThan(const Way& other) const {
        return metres != other.metres ? metres < other.metres : turned < other.turned;
    }
};

}  // namespace

/// Of the known ones that it may continue; null: of none.
ViewTurns::Known* ViewTurns::nearest(const lod::Channel& channel) {
    Known* nearest = nullptr;
    for (Known& known : known_)
        if (lod::mayContinue(known.channel, channel) &&
            (nearest == nullptr ||
             Way(known.channel, channel).isShorterThan(Way(nearest->channel, channel))))
            nearest = &known;
    return nearest;
}

/// Whether some view was lately there, all but, seen from the way there from `last`.
bool ViewTurns::hasBeenSeen(const lod::Channel& channel, const lod::Channel& last) const {
    const Way way(last, channel);
    return !way.isNone() && std::ranges::any_of(recent_, [&](const lod::Channel& before) {
        const Way back(before, channel);
        return back.metres <= kComesBack * way.metres && back.turned <= kComesBack * way.turned &&
               lod::mayContinue(before, channel);
    });
}

/// In place of the one not drawn longest where there are too many.
ViewTurns::Known& ViewTurns::add(const lod::Channel& channel) {
    if (known_.size() == kMost)
        known_.erase(std::ranges::min_element(known_, {}, &Known::drawn));
    known_.push_back({++lastName_, channel});
    return known_.back();
}

ViewTurn ViewTurns::next(const lod::Channel& channel, fabric::Completeness completeness) {
    ++now_;
    Known* view = nearest(channel);
    if (view == nullptr || hasBeenSeen(channel, view->channel)) {
        view = &add(channel);
    } else if (const std::uint64_t others = now_ - view->drawn - 1; others > 0) {
        view->othersDrawn = others <= kLongestRound ? others : 0;
    }
    view->channel = channel;
    view->drawn = now_;
    view->isExpected = completeness == fabric::Completeness::Interactive;
    recent_.push_back(channel);
    if (recent_.size() > kMost)
        recent_.pop_front();
    others_.clear();
    for (const Known& known : known_)
        if (&known != view && known.isExpected && now_ - known.drawn <= 2 * known.othersDrawn)
            others_.push_back(known.name);
    return {view->name, others_};
}

void ViewTurns::forget() {
    known_.clear();
    recent_.clear();
}

}  // namespace eyrie::draw
