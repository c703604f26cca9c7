// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/statistics.h"
#include "fabric/viewport.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/occluded_draw.h"
#include "renderer/draw/open_object.h"
#include "renderer/draw/view_turns.h"
#include "renderer/lod/view.h"

/// What of a scene falls to a channel.
namespace eyrie::draw {

/// Whether not all that is drawn is filled surfaces.
bool hasLines(const fabric::FrameData& frameData);

/// Pixels that what falls to a channel may touch. A line reaches half a pixel beyond its place, so
/// the piece it belongs to may lie beside the channel.
fabric::PixelViewport reach(const fabric::FrameData& frameData, const fabric::PixelViewport& part);

/// The view that the cut is chosen for: `whole`, or that of the camera of a cut that was frozen.
lod::View cutViewOf(const fabric::Look& look, const fabric::ChannelTask& task,
                    const lod::View& whole);

/// What a channel draws, and the pixels outside which none of it falls.
struct Selection {
    std::vector<OrderedPiece> pieces;
    /// With parts that are blended, of any range, the farthest first.
    std::vector<OrderedPiece> blended;
    std::vector<fabric::Mat4> worldFromObject;  ///< of each object, as drawn
    fabric::PixelViewport covered;
};

/// The pieces of all objects that fall to the task, object after object, of each in the order of
/// their place in its range. Every channel of a frame draws in that order, so where depths tie the
/// lower range wins in one channel as it does in compositing.
///
/// What is blended falls to every range: of the channels that are composited, that which has the
/// nearest opaque surface of a pixel wins, and has to have drawn all that is in front of it.
/// `turn` is that of the view that the cut is chosen for.
/// Adds to `statistics` what was loaded and what is missing. After `stop` it is not to be drawn.
Selection selectPieces(std::span<const OpenObject> objects, const lod::TaskViews& views,
                       const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                       const ViewTurn& turn, fabric::FrameStatistics& statistics,
                       const std::stop_token& stop = {});

}  // namespace eyrie::draw
