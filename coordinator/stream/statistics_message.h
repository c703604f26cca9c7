// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/frame/frame_source.h"

namespace eyrie::v1 {
class FrameStatistics;
}

namespace eyrie::stream {

/// All that is said of a whole frame, whose picture has so many pixels.
v1::FrameStatistics statisticsMessage(const coordinator::RenderedFrame& frame, int width,
                                      int height);

}  // namespace eyrie::stream
