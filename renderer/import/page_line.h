// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/eyt_writer.h"
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
};

/// Builds all pages in parallel and writes them in their order; fills in index.tiles and
/// index.pages, each tile's record covering those of the tiles under it. Stage "building".
/// Errors: the writer's, the scratch's, Cancelled.
absl::Status buildPages(const PageSources& sources, const terrain::Scratch& scratch,
                        const ImportControl& control, terrain::EytIndex& index,
                        terrain::EytWriter& writer);

}  // namespace eyrie::import
