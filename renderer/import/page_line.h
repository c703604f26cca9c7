// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <absl/status/status.h>

#include "renderer/import/part_set.h"
#include "renderer/import/progress.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/height_layers.h"
#include "renderer/terrain/normal_map.h"
#include "renderer/terrain/vertex_levels.h"

namespace eyrie::import {

/// What pages are built from.
struct PageSources {
    const terrain::ElevationModel& model;
    const terrain::HeightLayers& heights;
    const terrain::VertexLevels& levels;
    const terrain::NormalMaps& normals;
    terrain::HeightLattice lattice;
    bool isRounded = false;          ///< the model's heights are, to floats
    const PartSet* parts = nullptr;  ///< pages that are built already; may be null
};

/// Where a page goes, which is empty where nothing is in it. One thread at a time.
using PageSink =
    std::function<absl::Status(std::uint32_t page, std::span<const std::uint32_t> bytes)>;

/// Builds `pages` in parallel and hands them to `sink` in their order; fills in their tiles'
/// records in index.tiles, of each tile by itself. Stage "building". Errors: the sink's, the
/// parts', the scratch's, Cancelled.
absl::Status buildPages(const PageSources& sources, std::span<const std::uint32_t> pages,
                        const terrain::Scratch& scratch, const ImportControl& control,
                        terrain::EytIndex& index, const PageSink& sink);

/// Makes each tile's record cover those of the tiles under it, once all are built.
void saturate(terrain::EytIndex& index);

/// Calls visit(tile, place) for each tile that a page has.
template <typename Visit>
void forEachTileOfPage(const terrain::Quadtree& quadtree, std::uint32_t page, Visit visit) {
    const terrain::TileId first = quadtree.firstTileOfPage(page);
    for (std::int32_t place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place) {
        const terrain::TileId tile{first.level, first.x + place % terrain::kPageTiles,
                                   first.y + place / terrain::kPageTiles};
        if (quadtree.contains(tile))
            visit(tile, place);
    }
}

}  // namespace eyrie::import
