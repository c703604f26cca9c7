// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/range.h"
#include "fabric/viewport.h"
#include "renderer/lod/view.h"

namespace eyrie::lod {

/// Which part of which view is drawn, and of how much of the data.
struct Channel {
    View view;
    fabric::Range range;
    fabric::PixelViewport part;  ///< of the view's pixels
};

/// Whether `next` may be what `last` became a frame later: of the same picture size and wall, of
/// half the same pixels, frustum and data or more, and looking nearly the same way. Where from does
/// not count: a camera may go any distance.
bool mayContinue(const Channel& last, const Channel& next);

}  // namespace eyrie::lod
