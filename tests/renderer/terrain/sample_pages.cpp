// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/terrain/sample_pages.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "renderer/terrain/eyt_writer.h"
#include "renderer/terrain/normal_map.h"
#include "renderer/terrain/tile_samples.h"
#include "renderer/terrain/vertex_levels.h"
#include "tests/renderer/terrain/grid_model.h"

namespace eyrie::test {
namespace {

using terrain::TileGeometry;
using terrain::TileId;

terrain::HeightGrid gridOf(const SampleTerrain& sample) {
    terrain::HeightGrid grid = hardGrid(sample.kind, sample.columns, sample.rows, sample.seed);
    Random random(sample.seed + 1);
    const auto holes = static_cast<int>(sample.nodataShare * sample.columns * sample.rows / 4);
    for (int hole = 0; hole < holes; ++hole) {
        const std::int32_t i = random.integer(0, grid.columns - 1);
        const std::int32_t j = random.integer(0, grid.rows - 1);
        for (std::int32_t y = j; y < std::min(j + 2, grid.rows); ++y)
            for (std::int32_t x = i; x < std::min(i + 2, grid.columns); ++x)
                grid.row(y)[x] = terrain::kNodata;
    }
    return grid;
}

void makeNoise(std::vector<std::int8_t>& normals, std::uint64_t seed) {
    Random random(seed);
    for (std::int8_t& value : normals) value = static_cast<std::int8_t>(random.integer(-128, 127));
}

std::vector<terrain::TileVertex> verticesOf(const TileGeometry& tile) {
    std::vector<terrain::TileVertex> vertices;
    for (std::size_t k = 0; k < tile.vertexCount(); ++k)
        vertices.push_back(terrain::unpackVertex(tile.words, tile.wordsPerVertex, k,
                                                 tile.baseHeight, tile.heightMultiplier));
    return vertices;
}

std::string difference(const SamplePage::Tile& expected, const TileGeometry& tile, int level) {
    if (!std::ranges::equal(tile.normals, expected.normals))
        return "normals";
    if (expected.mesh.indices.empty())
        return tile.isEmpty() ? "" : "a tile without triangles has some";
    const terrain::HeightPacking packing = terrain::chooseHeightPacking(expected.mesh.vertices);
    if (tile.baseHeight != packing.base || tile.heightMultiplier != 1 << packing.shift ||
        tile.wordsPerVertex != packing.wordsPerVertex)
        return "the packing of heights";
    if (tile.cells != terrain::Quadtree::cells(level))
        return "cells";
    if (!std::ranges::equal(verticesOf(tile), expected.mesh.vertices))
        return "vertices";
    if (!std::ranges::equal(tile.indices, expected.mesh.indices))
        return "indices";
    return tile.parts == expected.mesh.parts ? "" : "parts";
}

std::string broken(const TileGeometry& tile) {
    const auto samples = static_cast<std::size_t>(tile.cells + 1);
    if (!tile.normals.empty() && tile.normals.size() != 2 * samples * samples)
        return "number of normals";
    std::uint32_t next = 0;
    for (const terrain::IndexRange& part : tile.parts) {
        if (part.first != next || part.count % 3 != 0)
            return "parts";
        next += part.count;
    }
    if (next != tile.indices.size())
        return "number of indices";
    for (const std::uint16_t index : tile.indices)
        if (index >= tile.vertexCount())
            return "an index";
    for (const terrain::TileVertex& vertex : verticesOf(tile))
        if (vertex.x > 2 * tile.cells || vertex.y > 2 * tile.cells || vertex.q < tile.baseHeight ||
            vertex.q > 1 << 23)
            return "a vertex";
    return "";
}

}  // namespace

std::vector<SamplePage> samplePages(const SampleTerrain& sample) {
    const terrain::HeightGrid grid = gridOf(sample);
    const terrain::Quadtree quadtree(static_cast<std::uint32_t>(grid.columns),
                                     static_cast<std::uint32_t>(grid.rows));
    GridModel model(grid);
    std::vector<double> thresholds;
    for (int level = 0; level < quadtree.levels(); ++level)
        thresholds.push_back(sample.finestThresholdMetres * (1 << level));
    terrain::VertexLevels levels(model.model(), model.scratch());
    levels.setThresholds(thresholds);
    const int layers = terrain::Quadtree::spacingShift(quadtree.levels() - 1) + 1;
    terrain::HeightLayers heights(model.model(), model.scratch(), layers);
    terrain::NormalMaps normals(model.model(), model.scratch(), quadtree.levels());
    for (const absl::Status& status : {levels.measure({}), levels.join({}), levels.finish({}),
                                       heights.make({}), normals.make({})})
        if (!status.ok())
            throw std::runtime_error(status.ToString());
    const terrain::HeightLattice lattice{sample.stepMetres, false};
    terrain::TileSamples samples(heights, levels);
    terrain::TileMesher mesher(model.surface(), samples, lattice, quadtree);

    Random random(sample.seed);
    std::vector<SamplePage> pages;
    for (std::uint32_t number = 0; number < quadtree.pageCount(); ++number) {
        const TileId first = quadtree.firstTileOfPage(number);
        SamplePage page;
        page.level = first.level;
        terrain::PageBuilder builder;
        for (int place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place) {
            const TileId id{first.level, first.x + place % terrain::kPageTiles,
                            first.y + place / terrain::kPageTiles};
            if (!quadtree.contains(id))
                continue;
            SamplePage::Tile& tile = page.tiles[static_cast<std::size_t>(place)];
            tile.mesh = mesher.mesh(id);
            if (random.unit() < sample.shareWithNormals) {
                tile.normals.resize(terrain::normalMapBytes(id.level));
                normals.fill(id, tile.normals);
            }
            if (sample.hasNoisyNormals)
                makeNoise(tile.normals, sample.seed + static_cast<std::uint64_t>(place));
            builder.add(place, id.level, tile.mesh, tile.normals);
        }
        page.bytes = builder.finish();
        if (!page.bytes.empty())
            pages.push_back(std::move(page));
    }
    return pages;
}

std::string difference(const SamplePage& expected, const terrain::Page& page) {
    for (int place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place) {
        const std::string found = difference(expected.tiles[static_cast<std::size_t>(place)],
                                             page.tile(place), expected.level);
        if (!found.empty())
            return fmt::format("level {}, tile {}: {}", expected.level, place, found);
    }
    return "";
}

std::string broken(const terrain::Page& page) {
    for (int place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place)
        if (const std::string found = broken(page.tile(place)); !found.empty())
            return fmt::format("tile {}: {}", place, found);
    return "";
}

}  // namespace eyrie::test
