// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fabric/image.h"
#include "fabric/lent_image.h"
#include "fabric/range.h"
#include "fabric/raster.h"
#include "fabric/sight.h"
#include "fabric/statistics.h"
#include "fabric/viewport.h"

namespace eyrie::fabric {

/// Whether a frame waits for data.
enum class Completeness {
    Complete,     ///< it shows the error asked for, however long loading takes
    Interactive,  ///< it shows at once what is there; what is missing is loaded for the next ones
};

/// One renderer's part of one frame: which pixels of which view, and which share of the data.
struct ChannelTask {
    std::uint64_t frameNumber = 0;
    std::uint64_t frameDataVersion = 0;
    /// Size of the whole view in pixels, 1 to 16384 a side. Projection, level of detail and
    /// rasterisation are the view's, whatever part of it is asked for: that is what makes the
    /// parts of a sort-first frame equal to the whole.
    std::int32_t viewWidth = 0;
    std::int32_t viewHeight = 0;
    PixelViewport pixelViewport;  ///< the part of the view to draw
    Range range;                  ///< the share of the data to draw
    bool wantsDepth = false;      ///< depth is to come back beside colour
    Completeness completeness = Completeness::Complete;
    /// Whether, after the picture, its vertices are drawn once more to tell how long they take
    /// (StageMilliseconds::vertices). The total goes without that.
    bool measuresStages = false;
    /// What the view is seen through; nothing: straight ahead from the camera, by its field of
    /// view.
    std::optional<Sight> sight = {};
    /// The points of the view that are drawn; nothing: its pixels' centres. pixelViewport, and the
    /// image that comes back, count the raster's pixels.
    std::optional<Raster> raster = {};
    /// 1 to 100: the picture goes to browsers as it is, and comes back as a JPEG of that quality
    /// with chroma halved (ChannelResult::jpeg); not where depth is wanted. 0: its pixels come.
    std::int32_t jpegQuality = 0;

    bool operator==(const ChannelTask&) const = default;
};

/// All the pixels that a task counts in: its raster's or, without one, its view's.
inline PixelViewport pictureOf(const ChannelTask& task) {
    return task.raster ? PixelViewport{0, 0, task.raster->width, task.raster->height}
                       : PixelViewport{0, 0, task.viewWidth, task.viewHeight};
}

/// What came of a task. `image.area` is the covered part of the task's pixel viewport: whatever of
/// it the image leaves out is background.
struct ChannelResult {
    Image image;
    FrameStatistics statistics;
    /// All of the task's pixel viewport, background too, where the task wants it so; `image` then
    /// has an area and no pixels.
    std::vector<std::byte> jpeg = {};
    /// The picture, where it is in memory that the renderer drew into; `image` then has an area and
    /// no pixels.
    std::optional<LentImage> lent = {};
};

inline constexpr std::int32_t kMaxViewPixels = 16384;

}  // namespace eyrie::fabric
