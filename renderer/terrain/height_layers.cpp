// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/height_layers.h"

#include "fabric/status.h"
#include "renderer/terrain/tile_progress.h"

namespace eyrie::terrain {
namespace {

std::shared_ptr<float[]> thinned(const TiledRaster<float>& finer, std::int32_t x, std::int32_t y) {
    constexpr std::int32_t kSide = 2 * kRasterTileCells + 1;
    thread_local std::vector<float> posts(static_cast<std::size_t>(kSide) * kSide);
    readClamped(finer, {2 * x * kRasterTileCells, 2 * y * kRasterTileCells, kSide, kSide},
                posts.data());
    auto tile = TiledRaster<float>::newTile();
    for (std::int32_t v = 0; v < kRasterTilePosts; ++v)
        for (std::int32_t u = 0; u < kRasterTilePosts; ++u)
            tile[static_cast<std::size_t>(v * kRasterTilePosts + u)] =
                posts[static_cast<std::size_t>(2 * v * kSide + 2 * u)];
    return tile;
}

}  // namespace

HeightLayers::HeightLayers(const ElevationModel& model, Scratch& scratch, int layers)
    : model_(model), scratch_(scratch) {
    for (int k = 1; k < layers; ++k) {
        const auto over = [&](std::int32_t posts) { return ((posts - 1 + (1 << k) - 1) >> k) + 1; };
        thinned_.emplace_back(scratch, over(model.frame.columns), over(model.frame.rows));
    }
}

absl::Status HeightLayers::make(const import::ImportControl& control) {
    for (std::size_t k = 0; k < thinned_.size(); ++k) {
        const TiledRaster<float>& finer = layer(static_cast<int>(k));
        TiledRaster<float>& coarser = thinned_[k];
        const import::ImportControl quiet{{}, control.stop};
        RETURN_IF_ERROR(forEachTile(
            coarser.tilesX(), coarser.tilesY(), "thinning", scratch_, quiet,
            [&](std::int32_t x, std::int32_t y) { coarser.write(x, y, thinned(finer, x, y)); }));
        control.report("thinning",
                       static_cast<double>(k + 1) / static_cast<double>(thinned_.size()));
    }
    return absl::OkStatus();
}

}  // namespace eyrie::terrain
