// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include <absl/status/status.h>

#include "fabric/channel_task.h"
#include "fabric/delivery.h"
#include "fabric/frame_data.h"
#include "fabric/scene.h"
#include "fabric/statistics.h"
#include "renderer/draw/batches.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/occluded_draw.h"
#include "renderer/draw/open_object.h"
#include "renderer/draw/selection.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// A channel's frame: what of the scene it shows, from where, and who waits for it.
struct SceneFrame {
    const fabric::Scene& scene;
    std::span<const OpenObject> objects;
    const Selection& selection;
    const lod::View& view;  ///< that is drawn
    const fabric::FrameData& frameData;
    const fabric::ChannelTask& task;
    const fabric::Delivery& delivery;
};

/// Draws channels into a framebuffer of its own: opaque pieces, less those that are hidden, then
/// blended ones. GL thread.
class SceneDraw {
public:
    /// Into framebuffer(), which has to be as large as the view. Returns when the device has
    /// finished. Lines hide nothing, and are drawn with the piece they
    /// belong to, hidden or not. Errors: those of the drawables; Cancelled where nobody wants the
    /// picture any more.
    absl::Status draw(const SceneFrame& frame, fabric::FrameStatistics& statistics);

    /// How long vertices and pixels of the last frame, which `frame` is, took of its
    /// `milliseconds.draw`, if its task asked for that. The picture is spoilt.
    absl::Status measureStages(const SceneFrame& frame, fabric::StageMilliseconds& milliseconds);

    /// What was drawn.
    gl::Framebuffer& framebuffer() { return framebuffer_; }

    /// For another scene.
    void forget() { occludedDraw_.forget(); }

private:
    absl::Status drawPieces(std::span<const OpenObject> objects, const OccludedDraw::Pieces& pieces,
                            const FrameState& state, fabric::FrameStatistics& statistics);

    gl::Framebuffer framebuffer_;
    OccludedDraw occludedDraw_;
    Batches batches_;
    /// What the last frame drew, one after the other: some of it more than once.
    std::vector<OccludedDraw::Pieces> drawn_;
};

/// Cancelled once `stop` is asked for: nobody wants the picture any more.
absl::Status unlessStopped(const std::stop_token& stop);

}  // namespace eyrie::draw
