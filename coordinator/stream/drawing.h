// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/frame/frame_source.h"
#include "coordinator/stream/viewer_messages.h"
#include "fabric/smaller_picture.h"

namespace eyrie::stream {

/// What must be equal for a picture to be still right.
struct PictureSource {
    fabric::Scene scene;
    fabric::SceneInfo sceneInfo;
    std::vector<std::string> renderers;  ///< that are ready; who else comes and goes draws nothing
    bool isSoftware = true;  ///< one of their devices is, such as llvmpipe, or there is none yet
    std::vector<coordinator::CanvasStatus> canvases;
    std::uint64_t sceneRevision = 0;
    std::uint64_t displayRevision = 0;

    bool operator==(const PictureSource&) const = default;
};

PictureSource pictureSource(const coordinator::Status& status);

/// Of both sides of a picture of `view` while it moves, however good the links are: CPU
/// rasterisers, and renderers of which nothing is known yet (null), draw 1.2 Mpixel at most then,
/// and all of them at rest.
double movingScale(const ViewRequest& view, const PictureSource* source);

/// What to draw for `view`: its eye lifted out of the ground, unless it may be there, and both
/// sides `scale` of what they are, at the same error in metres.
coordinator::FrameRequest drawingOf(const ViewRequest& view, const fabric::SceneInfo* scene,
                                    double scale);

/// How far the eye of a view that may be under ground would be lifted otherwise; nothing where that
/// is not at all.
std::optional<fabric::Vec3> liftOf(const ViewRequest& view, const fabric::SceneInfo* scene);

/// Of one eye's picture as it was `asked` for; smaller than that where it was to hold a time.
/// `drawn` has both eyes' where they are asked for in one.
fabric::PictureSides drawnSides(const coordinator::FrameRequest& asked,
                                const fabric::PixelViewport& drawn);

/// Pixels of the view that one of a picture of it covers, the longer way. 1 or more.
double stretchOf(const ViewRequest& view, const fabric::PictureSides& drawn);

/// Puts errors in pixels of the picture into pixels of the view, to whose sides it is stretched.
void tellAtFullSize(fabric::FrameStatistics& statistics, const ViewRequest& view,
                    const fabric::PictureSides& drawn);

}  // namespace eyrie::stream
