// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_import.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "fabric/status.h"
#include "renderer/import/dem_source.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_writer.h"
#include "renderer/terrain/normal_map.h"
#include "renderer/terrain/tile_mesh.h"
#include "renderer/terrain/vertex_levels.h"

namespace eyrie::import {
namespace {

using terrain::HeightGrid;
using terrain::TileId;

std::vector<double> levelThresholds(int levels, double postMetres,
                                    const terrain::HeightLattice& lattice) {
    std::vector<double> thresholds;
    for (int level = 0; level < levels; ++level)
        thresholds.push_back(kErrorPerSpacing * postMetres *
                             std::exp2(level - terrain::kFullResolutionLevels + 1));
    thresholds[0] = lattice.isLossless ? 0 : lattice.stepMetres / 4;
    return thresholds;
}

fabric::Mat4 objectFromLattice(const HeightGrid& grid, const terrain::HeightLattice& lattice) {
    fabric::Mat4 m(1.0);
    m[0] = {grid.perColumn.x, grid.perColumn.y, 0, 0};
    m[1] = {grid.perRow.x, grid.perRow.y, 0, 0};
    m[2] = {0, 0, lattice.stepMetres, 0};
    m[3] = {grid.origin.x, grid.origin.y, 0, 1};
    return m;
}

float roundedUp(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) >= value
               ? nearest
               : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

/// A tile's record before its children are known; no heights while min > max.
terrain::TileRecord recordOf(const terrain::TileMesh& mesh, double rounding) {
    terrain::TileRecord record;
    record.errorMetres = mesh.errorMetres > 0 ? roundedUp(mesh.errorMetres + rounding) : 0;
    record.minHeightMetres = -roundedUp(-mesh.minHeightMetres);
    record.maxHeightMetres = roundedUp(mesh.maxHeightMetres);
    record.triangles = mesh.ownTriangles();
    return record;
}

/// Widens a level-0 record to the posts that its triangles leave out.
void coverPosts(const HeightGrid& grid, const TileId& tile, terrain::TileRecord& record) {
    if (record.triangles == 0)
        return;
    const std::int32_t side = terrain::Quadtree::side(0);
    const std::int32_t i0 = tile.x * side;
    const std::int32_t i1 = std::min(i0 + side, grid.columns - 1);
    const std::int32_t j1 = std::min(tile.y * side + side, grid.rows - 1);
    for (std::int32_t j = tile.y * side; j <= j1; ++j)
        for (std::int32_t i = i0; i <= i1; ++i) {
            const float h = grid.at(i, j);
            record.minHeightMetres = h < record.minHeightMetres ? h : record.minHeightMetres;
            record.maxHeightMetres = h > record.maxHeightMetres ? h : record.maxHeightMetres;
        }
}

/// Makes each record cover its children's, from the finest level up.
void saturate(terrain::EytIndex& index) {
    const terrain::Quadtree& quadtree = index.quadtree;
    for (int level = 1; level < quadtree.levels(); ++level)
        for (std::int32_t y = 0; y < quadtree.tilesY(level); ++y)
            for (std::int32_t x = 0; x < quadtree.tilesX(level); ++x) {
                const TileId tile{level, x, y};
                terrain::TileRecord& record = index.tiles[quadtree.tileIndex(tile)];
                for (int i = 0; i < 4; ++i) {
                    const TileId child = terrain::Quadtree::child(tile, i);
                    if (!quadtree.contains(child))
                        continue;
                    const terrain::TileRecord& finer = index.tile(child);
                    record.errorMetres = std::max(record.errorMetres, finer.errorMetres);
                    record.minHeightMetres =
                        std::min(record.minHeightMetres, finer.minHeightMetres);
                    record.maxHeightMetres =
                        std::max(record.maxHeightMetres, finer.maxHeightMetres);
                }
            }
    for (terrain::TileRecord& record : index.tiles)
        if (record.minHeightMetres > record.maxHeightMetres)
            record = {};  // no triangle here in any level
}

/// Builds pages in parallel and writes them in order.
class PageLine {
public:
    PageLine(const HeightGrid& grid, const terrain::SourceSurface& surface,
             const terrain::VertexLevels& levels, const terrain::HeightLattice& lattice,
             const terrain::NormalMaps& normals, double rounding, terrain::EytIndex& index,
             terrain::EytWriter& writer, const ImportControl& control)
        : grid_(grid),
          normals_(normals),
          rounding_(rounding),
          index_(index),
          writer_(writer),
          control_(control),
          meshers_([&] { return terrain::TileMesher(surface, levels, lattice, index.quadtree); }) {}

    absl::Status run() {
        std::uint32_t next = 0;
        const auto tokens = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
        tbb::parallel_pipeline(
            tokens,
            tbb::make_filter<void, std::uint32_t>(tbb::filter_mode::serial_in_order,
                                                  [&](tbb::flow_control& flow) {
                                                      if (!goesOn(next))
                                                          flow.stop();
                                                      return next++;
                                                  }) &
                tbb::make_filter<std::uint32_t, BuiltPage>(
                    tbb::filter_mode::parallel, [&](std::uint32_t page) { return build(page); }) &
                tbb::make_filter<BuiltPage, void>(tbb::filter_mode::serial_in_order,
                                                  [&](const BuiltPage& page) { write(page); }));
        return cancelled_.ok() ? status_ : cancelled_;
    }

private:
    struct BuiltPage {
        std::uint32_t number = 0;
        std::shared_ptr<const std::vector<std::uint32_t>> bytes;
    };

    bool goesOn(std::uint32_t page) {
        if (page >= index_.quadtree.pageCount() || hasFailed_)
            return false;
        cancelled_ = control_.check();
        return cancelled_.ok();
    }

    BuiltPage build(std::uint32_t number) {
        terrain::TileMesher& mesher = meshers_.local();
        terrain::PageBuilder builder;
        const TileId first = index_.quadtree.firstTileOfPage(number);
        std::vector<std::int8_t> normals(terrain::normalMapBytes(first.level));
        for (std::int32_t place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place) {
            const TileId tile{first.level, first.x + place % terrain::kPageTiles,
                              first.y + place / terrain::kPageTiles};
            if (!index_.quadtree.contains(tile))
                continue;
            const terrain::TileMesh mesh = mesher.mesh(tile);
            terrain::TileRecord record = recordOf(mesh, rounding_);
            if (tile.level == 0)
                coverPosts(grid_, tile, record);
            index_.tiles[index_.quadtree.tileIndex(tile)] = record;
            if (mesh.indices.empty())
                continue;
            normals_.fill(tile, normals);
            builder.add(place, tile.level, mesh, normals);
        }
        return {number,
                std::make_shared<const std::vector<std::uint32_t>>(std::move(builder).finish())};
    }

    void write(const BuiltPage& page) {
        if (hasFailed_)
            return;
        absl::StatusOr<terrain::PageRecord> record = writer_.addPage(*page.bytes);
        if (!record.ok()) {
            status_ = record.status();
            hasFailed_ = true;
            return;
        }
        index_.pages[page.number] = *record;
        control_.report("building",
                        static_cast<double>(page.number + 1) / index_.quadtree.pageCount());
    }

    const HeightGrid& grid_;
    const terrain::NormalMaps& normals_;
    double rounding_;
    terrain::EytIndex& index_;
    terrain::EytWriter& writer_;
    const ImportControl& control_;
    tbb::enumerable_thread_specific<terrain::TileMesher> meshers_;
    absl::Status status_;  // by the last stage
    std::atomic<bool> hasFailed_ = false;
    absl::Status cancelled_;  // by the first stage
};

TerrainImportReport reportOf(const HeightGrid& grid, const terrain::EytIndex& index,
                             std::uint64_t sizeBytes) {
    return {.columns = grid.columns,
            .rows = grid.rows,
            .levels = index.quadtree.levels(),
            .triangles = index.triangles(),
            .nodataPosts = index.nodataPosts,
            .sizeBytes = sizeBytes,
            .postMetres = grid.postMetres(),
            .heightStepMetres = index.heightStepMetres(),
            .finestErrorMetres = index.finestErrorMetres(),
            .coarsestErrorMetres = index.coarsestErrorMetres(),
            .notes = {}};
}

}  // namespace

absl::StatusOr<TerrainImportReport> importTerrain(const HeightGrid& grid,
                                                  const TerrainSource& source,
                                                  const std::string& out,
                                                  const ImportControl& control) {
    const terrain::HeightStatistics statistics = heightStatistics(grid);
    if (statistics.min > statistics.max)
        return absl::InvalidArgumentError(fmt::format("{}: all posts are nodata", source.name));
    ASSIGN_OR_RETURN(terrain::EytWriter writer, terrain::EytWriter::create(out));

    terrain::EytIndex index;
    index.quadtree = terrain::Quadtree(static_cast<std::uint32_t>(grid.columns),
                                       static_cast<std::uint32_t>(grid.rows));
    const terrain::HeightLattice lattice = chooseHeightLattice(statistics, grid.postMetres());
    index.objectFromLattice = objectFromLattice(grid, lattice);
    index.crsWkt = source.crsWkt;
    index.sourceHash = source.hash;
    index.nodataPosts = statistics.nodataPosts;
    index.tiles.resize(index.quadtree.tileCount());
    index.pages.resize(index.quadtree.pageCount());

    const terrain::SourceSurface surface(grid, statistics.nodataPosts > 0);
    ASSIGN_OR_RETURN(
        const terrain::VertexLevels levels,
        terrain::VertexLevels::compute(
            surface, levelThresholds(index.quadtree.levels(), grid.postMetres(), lattice),
            control));
    control.report("smoothing", 0);
    const terrain::NormalMaps normals(grid, index.quadtree.levels());
    const double highest = std::max(std::abs(static_cast<double>(statistics.min)),
                                    std::abs(static_cast<double>(statistics.max)));
    PageLine line(grid, surface, levels, lattice, normals, highest * terrain::kDeviationRounding,
                  index, writer, control);
    RETURN_IF_ERROR(line.run());
    saturate(index);
    if (index.triangles() == 0)
        return absl::InvalidArgumentError(fmt::format(
            "{}: no three neighbouring posts have data; check the nodata value", source.name));
    ASSIGN_OR_RETURN(const std::uint64_t sizeBytes, writer.commit(index));
    return reportOf(grid, index, sizeBytes);
}

absl::StatusOr<TerrainImportReport> importTerrain(const std::string& dem, const std::string& out,
                                                  const ImportControl& control) {
    ASSIGN_OR_RETURN(Dem source, readDem(dem, control));
    ASSIGN_OR_RETURN(
        TerrainImportReport report,
        importTerrain(source.grid, {dem, source.crsWkt, source.sourceHash}, out, control));
    report.notes = std::move(source.notes);
    return report;
}

}  // namespace eyrie::import
