// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/frame/frame_source.h"
#include "fabric/smaller_picture.h"

namespace eyrie::coordinator {

/// Of one eye's picture in what was `drawn` for `asked`, which has both eyes' where they are asked
/// for in one.
inline fabric::PictureSides sidesOfEye(const FrameRequest& asked,
                                       const fabric::PixelViewport& drawn) {
    const Shown& shown = asked.shown.front();
    return {drawn.width / shown.eyesAcross(), drawn.height / shown.eyesUp()};
}

}  // namespace eyrie::coordinator
