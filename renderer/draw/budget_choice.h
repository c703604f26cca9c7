// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/statistics.h"
#include "renderer/draw/open_object.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// The frame data with the tau that is drawn at: where there is a frame time to hold, what it comes
/// to is in `statistics.budget` (fabric/frame_budget.h). `view` is the whole one, so that every
/// channel comes to the same tau.
fabric::FrameData withinBudget(std::span<const OpenObject> objects, const lod::View& view,
                               const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                               fabric::FrameStatistics& statistics);

}  // namespace eyrie::draw
