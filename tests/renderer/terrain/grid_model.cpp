// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/terrain/grid_model.h"

#include <algorithm>

namespace eyrie::test {

GridModel::GridModel(const terrain::HeightGrid& grid, const std::string& path,
                     std::uint64_t budgetBytes)
    : scratch_(path, budgetBytes),
      model_{grid.frame(),
             {},
             terrain::TiledRaster<float>(scratch_, grid.columns, grid.rows),
             terrain::ReliefSummary(grid.columns, grid.rows)},
      surface_(model_) {
    model_.statistics.add(grid.heights.data(), static_cast<std::int32_t>(grid.heights.size()));
    for (std::int32_t y = 0; y < model_.heights.tilesY(); ++y)
        for (std::int32_t x = 0; x < model_.heights.tilesX(); ++x) {
            auto tile = terrain::TiledRaster<float>::newTile();
            for (std::int32_t v = 0; v < terrain::kRasterTilePosts; ++v)
                for (std::int32_t u = 0; u < terrain::kRasterTilePosts; ++u)
                    tile[static_cast<std::size_t>(v * terrain::kRasterTilePosts + u)] =
                        grid.at(std::min(x * terrain::kRasterTileCells + u, grid.columns - 1),
                                std::min(y * terrain::kRasterTileCells + v, grid.rows - 1));
            model_.relief.add(x, y, tile.get());
            model_.heights.write(x, y, std::move(tile));
        }
}

}  // namespace eyrie::test
