// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "renderer/draw/drawable.h"
#include "renderer/draw/shared_need.h"
#include "renderer/draw/view_turns.h"
#include "renderer/page/tau_ladder.h"

namespace eyrie::draw {

/// By how much one drawable raises tau so that what a view needs fits on the device, together with
/// what the views need that it takes turns with: it rises for all of them by the same factor.
class TauChoice {
public:
    /// `itemsOf(view, tauPixels, step)` says what a whole view needs at a step of the ladder, which
    /// makes what was asked for `tauPixels`; `view` is `request.view` itself or another's. What a
    /// channel needs is judged by its share: channels with equal shares choose the same step.
    /// Views that are all drawn once more, or one that is waited for, get the lowest that fits.
    template <typename Items>
    page::TauLadder::Choice choose(const CutRequest& request, const Items& itemsOf,
                                   std::uint64_t roomBytes) {
        const bool isInteractive = request.completeness == fabric::Completeness::Interactive;
        Known& own = views_.of(request.turn);
        own.ask(request);
        const auto forEach = [&](const auto& visit) {
            for (auto& [name, view] : views_.all())
                if (isInteractive || &view == &own)
                    visit(view);
        };
        situation_.clear();
        forEach([&](const Known& view) { situation_.push_back(*view.asked); });
        if (settled_ == situation_)
            return {ladder_.step(), true};
        const auto need = [&](int step) {
            std::vector<ViewNeed> needs;
            forEach([&](Known& view) {
                const lod::ObjectView& from = &view == &own ? request.view : *view.view;
                needs.push_back({view.range, view.itemsAt(step, from, itemsOf)});
            });
            const std::uint64_t bytes = separateBytes(needs);
            // Clear of the limit in any case: nothing is won by looking closer.
            return needs.size() == 1 || bytes <= roomBytes / 10 * 9 ? bytes : sharedBytes(needs);
        };
        const bool isRepeated = last_ == situation_;
        last_ = situation_;
        if (!isRepeated && isInteractive) {
            settled_.clear();
            return ladder_.follow(need, roomBytes);
        }
        settled_ = situation_;
        return ladder_.settle(need, roomBytes);
    }

private:
    /// What decides which step of the ladder fits.
    struct Asked {
        explicit Asked(const CutRequest& request)
            : eye(request.view.view().eye),
              rotation(request.view.view().viewFromWorldRotation),
              frustum(request.view.view().frustum),
              focalPixels(request.view.view().focalPixels),
              tauPixels(request.tauPixels),
              share(request.range.end - request.range.begin),
              exaggeration(request.exaggeration) {}

        fabric::Vec3 eye;
        fabric::Mat3 rotation;
        fabric::Frustum frustum;
        fabric::Vec2 focalPixels;
        double tauPixels;
        double share;
        double exaggeration;

        bool operator==(const Asked&) const = default;
    };

    /// A view as it was last drawn.
    struct Known {
        std::optional<Asked> asked;
        std::optional<lod::ObjectView> view;
        fabric::Range range;
        std::vector<std::pair<int, std::vector<NeededItem>>> items;  ///< by step, where known

        void ask(const CutRequest& request) {
            range = request.range;
            const Asked now(request);
            if (asked == now)
                return;
            asked = now;
            view.emplace(request.view);
            items.clear();
        }

        template <typename Items>
        std::span<const NeededItem> itemsAt(int step, const lod::ObjectView& from,
                                            const Items& itemsOf) {
            for (const auto& [known, found] : items)
                if (known == step)
                    return found;
            const double tauPixels = asked->tauPixels * page::TauLadder::factor(step);
            return items.emplace_back(step, itemsOf(from, tauPixels, step)).second;
        }
    };

    page::TauLadder ladder_;
    PerView<Known> views_;
    std::vector<Asked> situation_;  ///< that is chosen for
    std::vector<Asked> last_;
    std::vector<Asked> settled_;  ///< whose lowest step the ladder is at
};

}  // namespace eyrie::draw
