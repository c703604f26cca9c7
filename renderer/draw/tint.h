// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/range.h"
#include "fabric/vec.h"
#include "renderer/draw/drawable.h"

namespace eyrie::draw {

/// Whether a colour stands in for the data's own.
inline bool isTinted(const FrameState& frame) {
    return frame.look.levelTint || frame.look.rangeTint || frame.colour;
}

/// Colours of levels of detail, linear. Neighbours differ clearly.
glm::vec3 levelColour(int level);

/// Colour of the share of the data that a channel draws, linear: the hue goes around the circle
/// with the middle of the range, so those of any number of ranges are evenly apart.
glm::vec3 rangeColour(const fabric::Range& range);

}  // namespace eyrie::draw
