// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "coordinator/compound/plan.h"
#include "coordinator/frame/active_configuration.h"
#include "coordinator/frame/dispatch.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/planned_frame.h"

namespace eyrie::coordinator {

/// The dispatch of draws of a frame: all of its plan, or some. `first` is for renderers of which
/// nothing is known.
Dispatch::Plan dispatchOf(const PlannedFrame& frame, const compound::Plan& draws, Takers takers,
                          std::chrono::milliseconds first);

/// A frame, and what each draw of its plan took, for equalizers.
struct DrawnFrame {
    RenderedFrame picture;
    std::vector<ActiveConfiguration::Taken> taken;
};

std::vector<ActiveConfiguration::Taken> takenBy(const std::vector<Dispatch::Drawn>& drawn);

/// What came of `task` when `renderer` drew it.
DrawnPart partOf(const fabric::ChannelTask& task, const std::string& renderer,
                 const fabric::FrameStatistics& statistics);

/// The pictures of `plan` from those of its draws: `drawn`, and after these `more`; or the frame's
/// tiles as they were drawn.
RenderedFrame composedFrame(const PlannedFrame& frame, const compound::Plan& plan,
                            std::vector<Dispatch::Drawn> drawn,
                            std::vector<fabric::Image> more = {});

}  // namespace eyrie::coordinator
