// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/camera.h"
#include "fabric/channel_task.h"
#include "fabric/image.h"
#include "fabric/statistics.h"
#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/truth/depth_comparison.h"
#include "renderer/truth/outline_displacement.h"
#include "renderer/truth/terrain_ray_caster.h"

namespace eyrie::truth {

/// Depth of the whole picture in metres, infinity for nothing, from the covered part of it.
std::vector<float> depthMetres(const fabric::Image& image, const fabric::PixelViewport& picture);

/// One picture: what the frame said of its error, and what there is.
struct PromiseKept {
    double promisedPixels = 0;
    DepthComparison measured;
    /// The greatest displacement found: of what the pixels show, and of every post that a picture
    /// of the source shows and halfway between posts (DrawnTerrain::farthestSeen), and of outlines
    /// (OutlineDisplacement).
    double measuredPixels = 0;
    double surfacePixels = 0;  ///< the same without outlines
    fabric::FrameStatistics statistics;
};

/// Holds what a renderer promises of one terrain against a ray cast of its source.
class TerrainPromise {
public:
    /// `renderer` has the terrain of `file` open, alone and where it lies. All are referred to.
    TerrainPromise(Renderer& renderer, const TerrainRayCaster& ground,
                   std::shared_ptr<const terrain::EytFile> file)
        : renderer_(renderer), ground_(ground), file_(std::move(file)) {
        const terrain::EytIndex& index = file_->index();
        if (index.nodataPosts > 0)
            outline_.emplace(index.quadtree, index.objectFromLattice, ground_);
    }

    /// Draws the picture, complete, and measures it. Errors: the renderer's.
    absl::StatusOr<PromiseKept> hold(const fabric::Camera& camera, double tauPixels, int width,
                                     int height) const;
    /// The same of what `task` says of a view's size, its sight and its raster; `judge` is that
    /// picture by other means.
    absl::StatusOr<PromiseKept> hold(const fabric::Camera& camera, double tauPixels,
                                     fabric::ChannelTask task, const Pinhole& judge) const;

    /// What rasterisation may add to what is promised: the 1/256 pixel that corners are rounded to.
    static constexpr double kRasterPixels = 1.0 / 256;
    /// The same of a raster's pixels.
    static double rasterPixels(const fabric::Vec2& step);

private:
    Renderer& renderer_;
    const TerrainRayCaster& ground_;
    std::shared_ptr<const terrain::EytFile> file_;
    std::optional<OutlineDisplacement> outline_;  ///< where there is one but the border
};

}  // namespace eyrie::truth
