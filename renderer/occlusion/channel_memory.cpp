// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/channel_memory.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace eyrie::occlusion {
namespace {

/// By so much an object has to be hidden to be expected to stay hidden: the camera moves, and what
/// is drawn after all costs more than what is drawn at once.
constexpr int kSparePixels = DepthPyramid::kBlockPixels;
/// Cosine of the angle between two directions of one viewer, from frame to frame.
constexpr double kNearlyTheSameWay = 0.8;

fabric::PixelViewport grownBy(const fabric::PixelViewport& rect, int pixels) {
    return {rect.x - pixels, rect.y - pixels, rect.width + 2 * pixels, rect.height + 2 * pixels};
}

double length(const fabric::Range& range) { return range.end - range.begin; }

bool areMostlyTheSame(const fabric::Range& a, const fabric::Range& b) {
    const fabric::Range both{std::max(a.begin, b.begin), std::min(a.end, b.end)};
    return 2 * length(both) >= std::max(length(a), length(b));
}

bool areMostlyTheSame(const fabric::PixelViewport& a, const fabric::PixelViewport& b) {
    return 2 * intersection(a, b).area() >= std::max(a.area(), b.area());
}

double area(const fabric::Frustum& f) { return (f.right - f.left) * (f.top - f.bottom); }

/// Two tiles of a wall have the same axis and size.
bool areMostlyTheSame(const fabric::Frustum& a, const fabric::Frustum& b) {
    const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double height = std::min(a.top, b.top) - std::max(a.bottom, b.bottom);
    return 2 * std::max(width, 0.0) * std::max(height, 0.0) >= std::max(area(a), area(b));
}

/// Along the view's axis.
fabric::Vec3 direction(const lod::View& view) {
    return -glm::transpose(view.viewFromWorldRotation)[2];
}

}  // namespace

bool ChannelMemory::expectsHidden(const lod::ObjectView& lastView,
                                  std::span<const fabric::Box> boxes,
                                  const fabric::PixelViewport& part) const {
    bool wasInPicture = false;
    for (const fabric::Box& bounds : boxes) {
        const fabric::PixelViewport covered = lastView.coveredPixels(bounds);
        const fabric::PixelViewport needed = intersection(covered, part);
        wasInPicture = wasInPicture || !needed.isEmpty();
        const bool isKnown = needed.isEmpty() || pyramid.area().contains(needed);
        if (!isKnown || !pyramid.hides(intersection(grownBy(covered, kSparePixels), part),
                                       nearestReversedDepth(lastView, bounds)))
            return false;
    }
    return isFresh && wasInPicture;
}

ChannelMemory& ChannelMemories::of(const lod::View& view, const fabric::Range& range,
                                   const fabric::PixelViewport& part) {
    const auto isLikeThis = [&](const Known& known) {
        const lod::View& last = known.memory.view;
        return last.width == view.width && last.height == view.height &&
               areMostlyTheSame(known.range, range) && areMostlyTheSame(known.part, part) &&
               areMostlyTheSame(last.frustum, view.frustum) &&
               glm::dot(direction(last), direction(view)) > kNearlyTheSameWay;
    };
    const auto found = std::find_if(memories_.begin(), memories_.end(), isLikeThis);
    if (found != memories_.end()) {
        memories_.splice(memories_.begin(), memories_, found);
    } else {
        // Whether it pays is more likely as it was just now than not.
        const Payoff payoff = memories_.empty() ? Payoff{} : memories_.front().memory.payoff;
        memories_.push_front({{view, {}, false, payoff}, range, part});
        if (memories_.size() > kMost)
            memories_.pop_back();
    }
    memories_.front().range = range;
    memories_.front().part = part;
    return memories_.front().memory;
}

}  // namespace eyrie::occlusion
