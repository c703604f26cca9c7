// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/terrain_promise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fabric/frustum.h"
#include "fabric/image.h"
#include "fabric/status.h"
#include "renderer/truth/drawn_terrain.h"
#include "renderer/truth/drawn_triangles.h"

namespace eyrie::truth {
namespace {

/// Depth of the whole view in metres, infinity for nothing, from the covered part of it.
std::vector<float> depthMetres(const fabric::Image& image, int width, int height) {
    fabric::Image whole = fabric::makeImage({0, 0, width, height}, {}, true);
    if (!image.area.isEmpty())
        fabric::paste(image, whole);
    std::vector<float> metres;
    for (const float reversed : whole.depth)
        metres.push_back(
            static_cast<float>(fabric::viewDepthMetres(reversed, fabric::kNearMetres)));
    return metres;
}

}  // namespace

absl::StatusOr<PromiseKept> TerrainPromise::hold(const fabric::Camera& camera, double tauPixels,
                                                 int width, int height) const {
    const fabric::FrameData frame{.version = 1, .camera = camera, .tauPixels = tauPixels};
    fabric::ChannelTask task;
    task.frameDataVersion = 1;
    task.viewWidth = width;
    task.viewHeight = height;
    task.pixelViewport = {0, 0, width, height};
    task.wantsDepth = true;
    ASSIGN_OR_RETURN(const fabric::ChannelResult drawn, renderer_.render(frame, task));
    PromiseKept kept{drawn.statistics.tauAchievedPixels, {}, 0, 0, drawn.statistics};

    const Pinhole pinhole(camera, width, height);
    ASSIGN_OR_RETURN(const DrawnTerrain triangles,
                     DrawnTerrain::of(*file_, lod::View(camera, width, height), tauPixels));
    const ShownPoint shown = [&](double x, double y, double depth) -> std::optional<fabric::Vec3> {
        const auto found = shownAt(triangles.triangles(), pinhole, x, y, depth, kReachPixels);
        return found ? std::optional(found->point) : std::nullopt;
    };
    // An outline may have moved by as much as everything else.
    const int edgePixels = static_cast<int>(std::clamp(std::ceil(kept.promisedPixels), 1.0, 8.0));
    const std::vector<float> depth = depthMetres(drawn.image, width, height);
    kept.measured = compareDepth(pinhole, depth, ground_, edgePixels,
                                 {kept.promisedPixels + kRasterPixels, shown});
    kept.surfacePixels = triangles.farthestSeen(pinhole, ground_, kept.measured.maxPixels);
    kept.measuredPixels =
        outline_ ? outline_->farthestSeen(pinhole, triangles, depth, kept.surfacePixels)
                 : kept.surfacePixels;
    return kept;
}

}  // namespace eyrie::truth
