// SPDX-License-Identifier: Apache-2.0
#include "fabric/channel_buffer.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "fabric/depth_merge.h"

namespace eyrie::fabric {

void ChannelBuffer::put(Image image, const PixelViewport& whole, Merge merge) {
    assert(area_.contains(whole));
    assert(image.area.isEmpty() || whole.contains(image.area));
    if (merge == Merge::Paste && image.area != whole)
        clear(whole);
    if (image.area.isEmpty())
        return;
    if (!hasDepth_)
        image.depth.clear();
    else if (!image.hasDepth())
        image.depth.assign(image.colour.size(), 0.0F);
    if (pixels_.area.isEmpty()) {
        pixels_ = std::move(image);
        return;
    }
    cover(image.area);
    if (merge == Merge::Paste)
        paste(image, pixels_);
    else
        mergeDepth(image, pixels_, merge == Merge::DepthBefore ? Ties::Source : Ties::Target);
}

Image ChannelBuffer::part(const PixelViewport& part, bool withDepth) const {
    const PixelViewport there = intersection(part, pixels_.area);
    if (there.isEmpty())
        return {};
    Image image{there, {}, {}};
    const bool depthToo = withDepth && hasDepth_;
    image.colour.reserve(static_cast<std::size_t>(there.area()));
    image.depth.reserve(depthToo ? static_cast<std::size_t>(there.area()) : 0);
    for (int y = there.y; y < there.y + there.height; ++y) {
        const auto begin = static_cast<std::ptrdiff_t>(y - pixels_.area.y) * pixels_.area.width +
                           (there.x - pixels_.area.x);
        image.colour.insert(image.colour.end(), pixels_.colour.begin() + begin,
                            pixels_.colour.begin() + begin + there.width);
        if (depthToo)
            image.depth.insert(image.depth.end(), pixels_.depth.begin() + begin,
                               pixels_.depth.begin() + begin + there.width);
    }
    return image;
}

void ChannelBuffer::cover(const PixelViewport& area) {
    const PixelViewport both = enclosing(pixels_.area, area);
    if (both == pixels_.area)
        return;
    Image larger = makeImage(both, background_, hasDepth_);
    paste(pixels_, larger);
    pixels_ = std::move(larger);
}

void ChannelBuffer::clear(const PixelViewport& area) {
    const PixelViewport there = intersection(area, pixels_.area);
    if (!there.isEmpty())
        paste(makeImage(there, background_, hasDepth_), pixels_);
}

}  // namespace eyrie::fabric
