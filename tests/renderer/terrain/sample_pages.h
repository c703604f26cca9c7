// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/tile_mesh.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::test {

/// What a page was built from.
struct SamplePage {
    struct Tile {
        terrain::TileMesh mesh;            ///< without indices: there is no tile
        std::vector<std::int8_t> normals;  ///< of no sample, or of all; with a mesh or without
    };

    int level = 0;
    std::array<Tile, terrain::kPageTiles * terrain::kPageTiles> tiles;
    std::vector<std::uint32_t> bytes;
};

struct SampleTerrain {
    GridKind kind = GridKind::Smooth;
    std::int32_t columns = 65;
    std::int32_t rows = 65;
    double stepMetres = 1.0 / 16;  ///< of the height lattice
    double nodataShare = 0;        ///< of all posts, in small holes
    double finestThresholdMetres = 0.5;
    double shareWithNormals = 1;   ///< of tiles, whatever their level
    bool hasNoisyNormals = false;  ///< any bytes; otherwise those of the terrain
    std::uint64_t seed = 1;
};

/// All pages of all levels that have triangles or normals.
std::vector<SamplePage> samplePages(const SampleTerrain& terrain);

/// In what the decoded page differs from what was put in; empty: in nothing.
std::string difference(const SamplePage& expected, const terrain::Page& page);

/// What a renderer relies on and the page breaks; empty: nothing.
std::string broken(const terrain::Page& page);

}  // namespace eyrie::test
