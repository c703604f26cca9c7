// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_import.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/import/dem_source.h"
#include "renderer/import/elevation_reading.h"
#include "renderer/import/imagery_pages.h"
#include "renderer/import/imagery_source.h"
#include "renderer/import/page_line.h"
#include "renderer/import/terrain_stages.h"
#include "renderer/import/texel_store.h"
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
        thresholds[0] = std::max(thresholds[0],
                                 *errorMetres - (lattice.isLossless ? 0 : lattice.stepMetres / 2));
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
    return {
        .columns = index.quadtree.columns(),
        .rows = index.quadtree.rows(),
        .levels = index.quadtree.levels(),
        .triangles = index.triangles(),
        .nodataPosts = index.nodataPosts,
        .sizeBytes = sizeBytes,
        .postMetres = postMetres,
        .heightStepMetres = index.heightStepMetres(),
        .finestErrorMetres = index.finestErrorMetres(),
        .coarsestErrorMetres = index.coarsestErrorMetres(),
        .imagery = index.imagery ? std::optional(terrain::summaryOf(*index.imagery)) : std::nullopt,
        .notes = {}};
}

/// Bytes that every import holds in memory, whatever lies on scratch.
std::uint64_t residentBytes(const terrain::GridFrame& frame, bool hasImagery) {
    // The program with GDAL and PROJ, GDAL's cache, strips and pages under way: measured.
    constexpr std::uint64_t kProgram = std::uint64_t{144} << 20;
    // Summaries, coarse vertex levels, tile records, and those again while they are written.
    constexpr std::uint64_t kPostsPerByte = 10;
    // What GDAL warps at once, and texture tiles under way.
    constexpr std::uint64_t kImagery = std::uint64_t{40} << 20;
    return kProgram + (hasImagery ? kImagery : 0) +
           static_cast<std::uint64_t>(frame.columns) * static_cast<std::uint64_t>(frame.rows) /
               kPostsPerByte;
}

std::uint64_t scratchBytes(const terrain::GridFrame& frame, const TerrainImportOptions& options) {
    constexpr std::uint64_t kLeast = std::uint64_t{4} << 20;
    const std::uint64_t resident = residentBytes(frame, !options.imagery.empty());
    const std::uint64_t memory = options.memoryBytes;
    return std::max(kLeast, memory > resident ? memory - resident : 0);
}

std::string scratchPath(const std::string& out, const std::string& folder) {
    namespace fs = std::filesystem;
    if (folder.empty())
        return out + ".scratch";
    const std::string whole = fs::absolute(out).lexically_normal().string();
    return (fs::path(folder) / fmt::format("{}-{:016x}.scratch", fs::path(out).filename().string(),
                                           XXH64(whole.data(), whole.size(), 0)))
        .string();
}

/// Removes what killed imports into `out` have left: EytWriter's unfinished files.
void removeLeftovers(const std::string& out) {
    namespace fs = std::filesystem;
    const fs::path whole = fs::absolute(out);
    const std::string mark = whole.filename().string() + ".partial-";
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(whole.parent_path(), error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(mark))
            continue;
        const pid_t maker = std::atoi(name.c_str() + mark.size());
        if (maker > 0 && kill(maker, 0) != 0 && errno == ESRCH)
            fs::remove(entry.path(), error);
    }
}

/// One import: what it holds, and its stages.
class TerrainJob {
public:
    /// `imagery` may be null.
    TerrainJob(HeightSource& posts, ImagerySource* imagery, const TerrainSource& source,
               const std::string& out, const TerrainImportOptions& options,
               const ImportControl& control)
        : posts_(posts),
          imagery_(imagery),
          source_(source),
          out_(out),
          options_(options),
          control_(control),
          scratch_(scratchPath(out, options.scratchFolder), scratchBytes(posts.frame(), options)),
          model_(emptyModel(posts.frame(), scratch_)),
          levels_(terrain::Quadtree(static_cast<std::uint32_t>(model_.frame.columns),
                                    static_cast<std::uint32_t>(model_.frame.rows))
                      .levels()),
          heights_(model_, scratch_, std::max(1, terrain::Quadtree::spacingShift(levels_ - 1))),
          normals_(model_, scratch_, levels_),
          vertexLevels_(model_, scratch_) {
        if (imagery_ != nullptr)
            texels_.emplace(imagery_->pyramid(), scratch_);
    }

    absl::StatusOr<TerrainImportReport> run() {
        removeLeftovers(out_);
        ASSIGN_OR_RETURN(terrain::EytWriter writer, terrain::EytWriter::create(out_));
        ASSIGN_OR_RETURN(TerrainStages stages,
                         TerrainStages::open(scratch_, key(), options_.startsOver));
        absl::StatusOr<TerrainImportReport> report = runStages(stages, writer);
        const bool mayGoOn = !report.ok() && !absl::IsInvalidArgument(report.status());
        if (!mayGoOn) {
            stages.remove();
        } else if (const std::string kept = stages.keptIn(); !kept.empty()) {
            const auto message = report.status().message();
            return absl::Status(
                report.status().code(),
                fmt::format("{}; what is done is kept in {}: the same command goes on from there",
                            std::string_view(message.data(), message.size()), kept));
        }
        return report;
    }

private:
    std::uint64_t key() const {
        const std::string text = fmt::format(
            "{} {:x} {} {} {} {} {} {} {} {} {}", kImportVersion, source_.hash,
            model_.frame.columns, model_.frame.rows, model_.frame.origin.x, model_.frame.origin.y,
            model_.frame.perColumn.x, model_.frame.perColumn.y, model_.frame.perRow.x,
            model_.frame.perRow.y, options_.errorMetres.value_or(-1));
        return XXH64(text.data(), text.size(), 0);
    }

    absl::Status joinLevels() {
        RETURN_IF_ERROR(vertexLevels_.join(control_));
        return vertexLevels_.finish(control_);
    }

    absl::StatusOr<TerrainImportReport> runStages(TerrainStages& stages,
                                                  terrain::EytWriter& writer) {
        RETURN_IF_ERROR(stages.run(
            [&] { return readElevation(posts_, scratch_, control_, model_); },
            {[&] { return model_.state(); }, [&](const auto& s) { return model_.restore(s); }}));
        if (model_.statistics.min > model_.statistics.max)
            return absl::InvalidArgumentError(
                fmt::format("{}: all posts are nodata; check the nodata value", source_.name));
        const double postMetres = model_.frame.postMetres();
        const terrain::HeightLattice lattice = chooseHeightLattice(model_.statistics, postMetres);
        vertexLevels_.setThresholds(
            levelThresholds(levels_, postMetres, lattice, options_.errorMetres));
        RETURN_IF_ERROR(stages.run([&] { return vertexLevels_.measure(control_); }));
        RETURN_IF_ERROR(stages.run([&] { return joinLevels(); },
                                   {[&] { return vertexLevels_.state(); },
                                    [&](const auto& s) { return vertexLevels_.restore(s); }}));
        RETURN_IF_ERROR(stages.run([&] { return heights_.make(control_); }));
        RETURN_IF_ERROR(stages.run([&] { return normals_.make(control_); }));
        terrain::EytIndex index = indexOf(model_, lattice, source_);
        RETURN_IF_ERROR(buildPages({model_, heights_, vertexLevels_, normals_, lattice}, scratch_,
                                   control_, index, writer));
        if (index.triangles() == 0)
            return absl::InvalidArgumentError(fmt::format(
                "{}: no three neighbouring posts have data; check the nodata value", source_.name));
        if (imagery_ != nullptr) {
            ASSIGN_OR_RETURN(
                index.imagery,
                buildImagery(*imagery_, fmt::format("{}", fmt::join(options_.imagery, ", ")),
                             *texels_, scratch_, control_, writer));
        }
        ASSIGN_OR_RETURN(const std::uint64_t sizeBytes, writer.commit(index));
        return reportOf(index, postMetres, sizeBytes);
    }

    static constexpr int kImportVersion = 2;  ///< raise it when scratch or journal change

    HeightSource& posts_;
    ImagerySource* imagery_;
    const TerrainSource& source_;
    const std::string& out_;
    const TerrainImportOptions& options_;
    const ImportControl& control_;
    terrain::Scratch scratch_;
    terrain::ElevationModel model_;
    int levels_;
    terrain::HeightLayers heights_;
    terrain::NormalMaps normals_;
    terrain::VertexLevels vertexLevels_;
    std::optional<TexelStore>
        texels_;  ///< reserved last: where the rest lies does not depend on it
};

}  // namespace

absl::StatusOr<TerrainImportReport> importTerrain(HeightSource& posts, const TerrainSource& source,
                                                  const std::string& out,
                                                  const TerrainImportOptions& options,
                                                  const ImportControl& control) {
    const tbb::global_control threads(
        tbb::global_control::max_allowed_parallelism,
        options.threads > 0
            ? static_cast<std::size_t>(options.threads)
            : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    OpenImagery imagery;
    if (!options.imagery.empty()) {
        ASSIGN_OR_RETURN(imagery,
                         openImagery(options.imagery, posts.frame(), source.crsWkt, control));
    }
    ASSIGN_OR_RETURN(TerrainImportReport report,
                     TerrainJob(posts, imagery.texels.get(), source, out, options, control).run());
    report.notes = std::move(imagery.notes);
    return report;
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
    const std::string name = dems.size() == 1
                                 ? dems.front()
                                 : fmt::format("{} and {} more", dems.front(), dems.size() - 1);
    ASSIGN_OR_RETURN(
        TerrainImportReport report,
        importTerrain(*source.posts, {name, source.crsWkt, source.hash}, out, options, control));
    report.notes.insert(report.notes.begin(), source.notes.begin(), source.notes.end());
    return report;
}

}  // namespace eyrie::import
