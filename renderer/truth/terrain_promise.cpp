// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/terrain_promise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fabric/depth_metres.h"
#include "fabric/status.h"
#include "renderer/truth/drawn_terrain.h"
#include "renderer/truth/shown_surface.h"

namespace eyrie::truth {
std::vector<float> depthMetres(const fabric::Image& image, const fabric::PixelViewport& picture) {
    fabric::Image whole = fabric::makeImage(picture, {}, true);
    if (!image.area.isEmpty())
        fabric::paste(image, whole);
    return fabric::depthMetres(whole);
}

double TerrainPromise::rasterPixels(const fabric::Vec2& step) {
    return std::max(step.x, step.y) / 256;
}

absl::StatusOr<PromiseKept> TerrainPromise::hold(const fabric::Camera& camera, double tauPixels,
                                                 int width, int height) const {
    fabric::ChannelTask task;
    task.viewWidth = width;
    task.viewHeight = height;
    return hold(camera, tauPixels, task, Pinhole(camera, width, height));
}

absl::StatusOr<PromiseKept> TerrainPromise::hold(const fabric::Camera& camera, double tauPixels,
                                                 fabric::ChannelTask task,
                                                 const Pinhole& judge) const {
    const fabric::FrameData frame{.version = 1, .camera = camera, .tauPixels = tauPixels};
    task.frameDataVersion = 1;
    task.pixelViewport = fabric::pictureOf(task);
    task.wantsDepth = true;
    ASSIGN_OR_RETURN(const fabric::ChannelResult drawn, renderer_.render(frame, task));
    PromiseKept kept{drawn.statistics.tauAchievedPixels, {}, 0, 0, drawn.statistics};

    const lod::View view = lod::TaskViews(camera, task).whole;
    ASSIGN_OR_RETURN(const DrawnTerrain triangles, DrawnTerrain::of(*file_, view, tauPixels));
    const ShownSurface surface(triangles.triangles(), judge);
    const ShownPoint shown = [&](double x, double y, double depth) -> std::optional<DrawnPoint> {
        const auto found = surface.at(x, y, depth);
        return found
                   ? std::optional(DrawnPoint{found->point, 0, found->mayHaveDepth, found->isAtEnd})
                   : std::nullopt;
    };
    // An outline may have moved by as much as everything else.
    const fabric::Vec2 step = task.raster ? task.raster->step : fabric::Vec2(1);
    const int edgePixels = static_cast<int>(
        std::clamp(std::ceil(kept.promisedPixels / std::min(step.x, step.y)), 1.0, 8.0));
    const std::vector<float> depth = depthMetres(drawn.image, task.pixelViewport);
    kept.measured = compareDepth(judge, depth, ground_, edgePixels,
                                 {kept.promisedPixels + rasterPixels(step), shown});
    kept.surfacePixels = triangles.farthestSeen(judge, ground_, kept.measured.maxPixels);
    kept.measuredPixels = outline_
                              ? outline_->farthestSeen(judge, triangles, depth, kept.surfacePixels)
                              : kept.surfacePixels;
    return kept;
}

}  // namespace eyrie::truth
