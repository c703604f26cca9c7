// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/viewport.h"
#include "renderer/draw/open_object.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/lod/view.h"
#include "renderer/occlusion/hidden_ground.h"

namespace eyrie::draw {

/// A channel's picture that is finished.
struct FinishedPicture {
    const fabric::FrameData& frameData;
    const fabric::ChannelTask& task;
    const fabric::PixelViewport& covered;  ///< pixels outside which nothing was drawn
    gl::Framebuffer& framebuffer;          ///< where it still is
    occlusion::Reading depthReading;       ///< which way is quicker on the device
};

/// The screen-space error, in pixels, that it promises: a bound over all that is seen of `objects`.
/// Infinite for a frozen cut, which was chosen for another view. Hills hide what is behind them
/// where nothing is in the picture but one terrain, all of it opaque.
double promisedPixels(std::span<const OpenObject> objects, const lod::TaskViews& views,
                      const FinishedPicture& picture);

}  // namespace eyrie::draw
