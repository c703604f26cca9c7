// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/box.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// Holds what is drawn to the depth of the box it lies in. The plane of a triangle that is seen
/// edge-on may have any depth where the triangle covers a pixel, up to the near plane: it would be
/// drawn over all that is before it. docs/errors.md#rasterisation
///
/// By clamping to a depth range, which costs no test in the fragment stage: z is scaled in clip
/// space by as much as the range takes back. GL thread; one at a time.
class DepthLimit {
public:
    explicit DepthLimit(const lod::ObjectView& view) : view_(view) {}
    ~DepthLimit() { lift(); }
    DepthLimit(const DepthLimit&) = delete;
    DepthLimit& operator=(const DepthLimit&) = delete;

    /// Nothing drawn from now on is nearer than occlusion::nearestReversedDepth of `bounds` (object
    /// space), in which it has to lie. Returns what its program has to multiply z in clip space
    /// with. What reaches the near plane has no limit, and is cut off there.
    float holdTo(const fabric::Box& bounds);

    /// Other programs may draw.
    void lift();

private:
    const lod::ObjectView& view_;
    bool isHeld_ = false;
};

}  // namespace eyrie::draw
