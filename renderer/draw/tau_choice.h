// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "renderer/draw/drawable.h"
#include "renderer/page/tau_ladder.h"

namespace eyrie::draw {

/// By how much one drawable raises tau so that what a view needs fits on the device.
class TauChoice {
public:
    /// `need(step)` says how many bytes the whole view needs at a step of the ladder. What a
    /// channel needs is judged by its share of it, so that the channels of a frame choose the same
    /// step. A view that is drawn once more, or waited for, gets the lowest that fits.
    template <typename Need>
    page::TauLadder::Choice choose(const CutRequest& request, const Need& need,
                                   std::uint64_t roomBytes) {
        const double share = request.range.end - request.range.begin;
        const auto ofChannel = [&](int step) {
            return static_cast<std::uint64_t>(share * static_cast<double>(need(step)));
        };
        const Settled view(request, share);
        if (settled_ == view)
            return {ladder_.step(), true};
        const bool isRepeated = last_ == view;
        last_ = view;
        if (!isRepeated && request.completeness == fabric::Completeness::Interactive) {
            settled_.reset();
            return ladder_.follow(ofChannel, roomBytes);
        }
        settled_ = view;
        return ladder_.settle(ofChannel, roomBytes);
    }

private:
    /// What decides which step of the ladder fits.
    struct Settled {
        Settled(const CutRequest& request, double shareOfRange)
            : eye(request.view.view().eye),
              rotation(request.view.view().viewFromWorldRotation),
              frustum(request.view.view().frustum),
              focalPixels(request.view.view().focalPixels),
              tauPixels(request.tauPixels),
              share(shareOfRange),
              exaggeration(request.exaggeration) {}

        fabric::Vec3 eye;
        fabric::Mat3 rotation;
        fabric::Frustum frustum;
        fabric::Vec2 focalPixels;
        double tauPixels;
        double share;
        double exaggeration;

        bool operator==(const Settled&) const = default;
    };

    page::TauLadder ladder_;
    std::optional<Settled> last_;
    std::optional<Settled> settled_;  ///< whose lowest step the ladder is at
};

}  // namespace eyrie::draw
