// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/depth_limit.h"

#include "renderer/gl/object.h"
#include "renderer/occlusion/depth_pyramid.h"

namespace eyrie::draw {

float DepthLimit::holdTo(const fabric::Box& bounds) {
    const float nearest = occlusion::nearestReversedDepth(view_, bounds);
    if (!(nearest < 1)) {
        lift();
        return 1;
    }
    if (!isHeld_)
        glEnable(GL_DEPTH_CLAMP);
    isHeld_ = true;
    glDepthRangef(0, nearest);
    return 1 / nearest;
}

void DepthLimit::lift() {
    if (!isHeld_)
        return;
    isHeld_ = false;
    glDisable(GL_DEPTH_CLAMP);
    glDepthRangef(0, 1);
}

}  // namespace eyrie::draw
