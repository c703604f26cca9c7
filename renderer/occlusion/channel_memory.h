// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <span>

#include "fabric/range.h"
#include "renderer/lod/view.h"
#include "renderer/occlusion/depth_pyramid.h"
#include "renderer/occlusion/payoff.h"

namespace eyrie::occlusion {

/// What hid what in a channel's last frame: tells what is probably hidden in the next.
///
/// Remembered as the depth seen, not as a list of pieces: so it serves whatever pieces the next
/// frame has, of whatever level of detail. It may be wrong, for the camera has moved: what it tells
/// has to be tested again against the frame's own depth.
struct ChannelMemory {
    lod::View view;
    DepthPyramid pyramid;  ///< of `view`
    bool isFresh = false;  ///< whether they are the last frame's
    Payoff payoff;

    /// Whether all that lies in `boxes`, of an object that `lastView` sees in `view`, was hidden in
    /// the last frame with some pixels to spare. What was outside the picture counts as hidden, but
    /// not if all was. `part`: what the channel draws.
    bool expectsHidden(const lod::ObjectView& lastView, std::span<const fabric::Box> boxes,
                       const fabric::PixelViewport& part) const;
};

/// The memories of the channels that are drawn in turn: parts of a picture, ranges, viewers.
class ChannelMemories {
public:
    /// The one of the last frame like this (lod::mayContinue). A new one, in place of the one not
    /// used longest, if there is none: after a hard cut nothing is expected to be hidden.
    ChannelMemory& of(const lod::View& view, const fabric::Range& range,
                      const fabric::PixelViewport& part);
    void clear() { memories_.clear(); }

private:
    static constexpr std::size_t kMost = 16;

    struct Known {
        ChannelMemory memory;
        fabric::Range range;
        fabric::PixelViewport part;
    };
    std::list<Known> memories_;  ///< last used first
};

}  // namespace eyrie::occlusion
