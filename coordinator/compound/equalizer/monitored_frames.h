// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/compound/equalizer/balancer.h"

namespace eyrie::equalizer {

/// Gives output frames the zooms that Turn::monitored says, all others those that are written.
///
/// A frame has one zoom for all that take it on the canvases asked for: of several monitors the
/// largest, across and along by itself, and not less than is written where somebody takes it who is
/// no monitor at work. Where an input frame says how large each pixel of the frame is, that is
/// changed so that it comes as large as with the zoom that it alone would have given.
void zoomMonitoredFrames(Turn& turn);

}  // namespace eyrie::equalizer
