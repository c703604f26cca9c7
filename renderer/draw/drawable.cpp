// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/drawable.h"

namespace eyrie::draw {

FrameState frameOf(const FrameState& frame, std::size_t object) {
    FrameState own = frame;
    if (const fabric::ObjectLook* look = frame.look.objects.of(object)) {
        own.shading = look->shading.value_or(frame.shading);
        if (look->colour)
            own.colour = *look->colour * *look->colour;
    }
    return own;
}

}  // namespace eyrie::draw
