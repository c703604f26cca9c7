// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_import.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "fabric/status.h"
#include "renderer/import/dem_source.h"
#include "renderer/import/elevation_reading.h"
#include "renderer/import/page_line.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::import {
namespace {

std::vector<double> levelThresholds(int levels, double postMetres,
                                    const terrain::HeightLattice& lattice,
                                    const std::optional<double>& errorMetres) {
    std::vector<double> thresholds;
    for (int level = 0; level < levels; ++level)
        thresholds.push_back(kErrorPerSpacing * postMetres *
                             std::exp2(level - terrain::kFullResolutionLevels + 1));
    thresholds[0] = lattice.isLossless ? 0 : lattice.stepMetres / 4;
    if (errorMetres)  // half a step is for the heights' own rounding
        thresholds[0] = std::max(
            thresholds[0], *errorMetres - (lattice.isLossless ? 0 : lattice.stepMetres / 2));
    for (double& threshold : thresholds) threshold = std::max(threshold, thresholds[0]);
    return thresholds;
}

fabric::Mat4 objectFromLattice(const terrain::GridFrame& frame,
                               const terrain::HeightLattice& lattice) {
    fabric::Mat4 m(1.0);
    m[0] = {frame.perColumn.x, frame.perColumn.y, 0, 0};
    m[1] = {frame.perRow.x, frame.perRow.y, 0, 0};
    m[2] = {0, 0, lattice.stepMetres, 0};
    m[3] = {frame.origin.x, frame.origin.y, 0, 1};
    return m;
}

terrain::EytIndex indexOf(const terrain::ElevationModel& model,
                          const terrain::HeightLattice& lattice, const TerrainSource& source) {
    terrain::EytIndex index;
    index.quadtree = terrain::Quadtree(static_cast<std::uint32_t>(model.frame.columns),
                                       static_cast<std::uint32_t>(model.frame.rows));
    index.objectFromLattice = objectFromLattice(model.frame, lattice);
    index.crsWkt = source.crsWkt;
    index.sourceHash = source.hash;
    index.nodataPosts = model.statistics.nodataPosts;
    index.tiles.resize(index.quadtree.tileCount());
    index.pages.resize(index.quadtree.pageCount());
    return index;
}

TerrainImportReport reportOf(const terrain::EytIndex& index, double postMetres,
                             std::uint64_t sizeBytes) {
    return {.columns = index.quadtree.columns(),
            .rows = index.quadtree.rows(),
            .levels = index.quadtree.levels(),
            .triangles = index.triangles(),
            .nodataPosts = index.nodataPosts,
            .sizeBytes = sizeBytes,
            .postMetres = postMetres,
            .heightStepMetres = index.heightStepMetres(),
            .finestErrorMetres = index.finestErrorMetres(),
            .coarsestErrorMetres = index.coarsestErrorMetres(),
            .notes = {}};
}

}  // namespace

absl::StatusOr<TerrainImportReport> importTerrain(HeightSource& posts, const TerrainSource& source,
                                                  const std::string& out,
                                                  const TerrainImportOptions& options,
                                                  const ImportControl& control) {
    ASSIGN_OR_RETURN(terrain::EytWriter writer, terrain::EytWriter::create(out));
    terrain::Scratch scratch(out + ".scratch", options.memoryBytes / 2);
    terrain::ElevationModel model = emptyModel(posts.frame(), scratch);
    const int levels = terrain::Quadtree(static_cast<std::uint32_t>(model.frame.columns),
                                         static_cast<std::uint32_t>(model.frame.rows))
                           .levels();
    const int shift = terrain::Quadtree::spacingShift(levels - 1);
    terrain::HeightLayers heights(model, scratch, std::max(1, shift));
    terrain::NormalMaps normals(model, scratch, levels);
    terrain::VertexLevels vertexLevels(model, scratch);

    RETURN_IF_ERROR(readElevation(posts, scratch, control, model));
    if (model.statistics.min > model.statistics.max)
        return absl::InvalidArgumentError(fmt::format("{}: all posts are nodata", source.name));
    const terrain::HeightLattice lattice =
        chooseHeightLattice(model.statistics, model.frame.postMetres());
    vertexLevels.setThresholds(
        levelThresholds(levels, model.frame.postMetres(), lattice, options.errorMetres));
    RETURN_IF_ERROR(vertexLevels.measure(control));
    RETURN_IF_ERROR(vertexLevels.join(control));
    RETURN_IF_ERROR(vertexLevels.finish(control));
    RETURN_IF_ERROR(heights.make(control));
    RETURN_IF_ERROR(normals.make(control));
    terrain::EytIndex index = indexOf(model, lattice, source);
    RETURN_IF_ERROR(buildPages({model, heights, vertexLevels, normals, lattice}, scratch, control,
                               index, writer));
    if (index.triangles() == 0)
        return absl::InvalidArgumentError(fmt::format(
            "{}: no three neighbouring posts have data; check the nodata value", source.name));
    ASSIGN_OR_RETURN(const std::uint64_t sizeBytes, writer.commit(index));
    return reportOf(index, model.frame.postMetres(), sizeBytes);
}

absl::StatusOr<TerrainImportReport> importTerrain(const terrain::HeightGrid& grid,
                                                  const TerrainSource& source,
                                                  const std::string& out,
                                                  const ImportControl& control) {
    GridHeightSource posts(grid);
    return importTerrain(posts, source, out, {}, control);
}

absl::StatusOr<TerrainImportReport> importTerrain(const std::vector<std::string>& dems,
                                                  const std::string& out,
                                                  const TerrainImportOptions& options,
                                                  const ImportControl& control) {
    ASSIGN_OR_RETURN(DemSource source, openDems(dems, control));
    const std::string name =
        dems.size() == 1 ? dems.front()
                         : fmt::format("{} and {} more", dems.front(), dems.size() - 1);
    ASSIGN_OR_RETURN(TerrainImportReport report,
                     importTerrain(*source.posts, {name, source.crsWkt, source.hash}, out, options,
                                   control));
    report.notes = std::move(source.notes);
    return report;
}

}  // namespace eyrie::import
