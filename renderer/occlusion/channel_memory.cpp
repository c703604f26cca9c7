// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/channel_memory.h"

#include <algorithm>

#include "renderer/lod/channel.h"

namespace eyrie::occlusion {
namespace {

/// By so much an object has to be hidden to be expected to stay hidden: the camera moves, and what
/// is drawn after all costs more than what is drawn at once.
constexpr int kSparePixels = DepthPyramid::kBlockPixels;

fabric::PixelViewport grownBy(const fabric::PixelViewport& rect, int pixels) {
    return {rect.x - pixels, rect.y - pixels, rect.width + 2 * pixels, rect.height + 2 * pixels};
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
    const lod::Channel channel{view, range, part};
    const auto found = std::ranges::find_if(memories_, [&](const Known& known) {
        return lod::mayContinue({known.memory.view, known.range, known.part}, channel);
    });
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
