// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fabric/partial_file.h"
#include "fabric/status.h"
#include "renderer/import/degrees_caveat.h"
#include "renderer/import/dem_source.h"
#include "renderer/import/elevation_reading.h"
#include "renderer/import/imagery_pages.h"
#include "renderer/import/imagery_source.h"
#include "renderer/import/page_line.h"
#include "renderer/import/part_set.h"
#include "renderer/import/picture_fingerprint.h"
#include "renderer/import/terrain_choices.h"
#include "renderer/import/terrain_stages.h"
#include "renderer/import/texel_store.h"
#include "renderer/import/thread_limit.h"
#include "renderer/import/written_levels.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::import {
namespace {

/// What heights look like that a file should have called nodata, and did not.
std::vector<std::string> notesOnHeights(const terrain::EytIndex& index) {
    std::vector<std::string> notes;
    constexpr std::array<float, 4> kOftenNodata = {-9999, -99999, -32767, -32768};
    const float lowest = index.tile(index.quadtree.top()).minHeightMetres;
    if (std::ranges::count(kOftenNodata, lowest) != 0)
        notes.push_back(fmt::format(
            "the lowest height is {} m, which often means nodata; if it does, the file must say so "
            "(gdal_edit.py -a_nodata {})",
            lowest, lowest));
    // Steps of more than a metre come of heights of thousands of kilometres alone.
    constexpr double kFewestSteps = 1 << 22;  // to the highest, or the step were half as large
    if (const double step = index.heightStepMetres(); step > 1)
        notes.push_back(fmt::format(
            "heights reach beyond {:.3g} m, so all are kept in steps of {} m; if those are none, "
            "the file must call them nodata (gdal_edit.py -a_nodata)",
            step * kFewestSteps, step));
    return notes;
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
        .notes = notesOnHeights(index)};
}

/// Where parts are missing they may have been merged: of an output that is there its sources are
/// known, but not the options.
std::vector<std::string> notesOnOutput(const std::string& out, const PartIdentity& identity) {
    const auto file = terrain::EytFile::open(out);
    if (!file.ok() || (*file)->index().sourceHash != identity.sourceHash ||
        (*file)->index().quadtree.columns() != identity.columns ||
        (*file)->index().quadtree.rows() != identity.rows)
        return {};
    return {
        fmt::format("{} is there, made of these sources: if it was with these options, too, "
                    "nothing is left to be done",
                    out)};
}

/// Posts that stand one by one, or in a line, or around a half of a cell that is none of the
/// grid's.
absl::Status noTriangles(const std::string& name, const terrain::ElevationModel& model) {
    const auto posts = static_cast<std::uint64_t>(model.frame.columns) *
                       static_cast<std::uint64_t>(model.frame.rows);
    return absl::InvalidArgumentError(
        fmt::format("{}: {} of {} posts have data, but no triangle of the grid has data at all of "
                    "its corners, so there is nothing to draw; check the nodata value",
                    name, posts - model.statistics.nodataPosts, posts));
}

absl::Status explained(const absl::Status& error, const std::vector<std::string>& findings) {
    std::string message(error.message());
    for (const std::string& finding : findings) message += "; " + finding;
    return absl::Status(error.code(), message);
}

/// One import: what it holds, and its stages.
class TerrainJob {
public:
    /// `imagery` and `parts` may be null.
    TerrainJob(HeightSource& posts, ImagerySource* imagery, const PartSet* parts,
               const TerrainSource& source, const std::string& out,
               const TerrainImportOptions& options, const ImportControl& control)
        : posts_(posts),
          imagery_(imagery),
          parts_(parts),
          source_(source),
          out_(out),
          options_(options),
          control_(control),
          scratch_(scratchPath(out, options.scratchFolder),
                   scratchBytes(posts, imagery, options.memoryBytes)),
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
        fabric::removeAbandoned(out_);
        ASSIGN_OR_RETURN(terrain::EytWriter writer, scratch_.fitsInMemory()
                                                        ? terrain::EytWriter::create(out_)
                                                        : terrain::EytWriter::resume(out_));
        ASSIGN_OR_RETURN(TerrainStages stages, TerrainStages::open(scratch_, scratchPath(out_, ""),
                                                                   key(), options_.startsOver));
        absl::StatusOr<TerrainImportReport> report = runStages(stages, writer);
        writer.keepUnfinished(stages.goesOnLater(report.status()));
        if (!stages.areKept() && (report.ok() || options_.startsOver))
            terrain::EytWriter::removeUnfinished(out_);  // of one that had less memory
        RETURN_IF_ERROR(stages.end(report.status()));
        return report;
    }

private:
    /// Without the pictures: their stages know by themselves what is still of use.
    std::uint64_t key() const {
        return stagesKey(
            identityOf(model_.frame, source_.hash, options_.errorMetres.value_or(-1), 0, 1), 0);
    }

    absl::Status makeLevels() {
        RETURN_IF_ERROR(parts_ ? parts_->gatherMeasured(scratch_, control_, vertexLevels_)
                               : vertexLevels_.measure(control_));
        RETURN_IF_ERROR(vertexLevels_.join(control_));
        vertexLevels_.forgetMeasured();
        return vertexLevels_.finish(control_);
    }

    /// Levels with all posts first: what coarser ones are made from would take the memory of what
    /// three passes over all posts need.
    absl::Status writePages(const terrain::HeightLattice& lattice, TerrainStages& stages,
                            terrain::EytIndex& index, terrain::EytWriter& writer) {
        const PageSources sources{model_,  heights_,          vertexLevels_, normals_,
                                  lattice, source_.isRounded, parts_};
        const int coarse = std::min(levels_, terrain::kFullResolutionLevels);
        const auto write = [&](int first, int end) {
            return writeLevels(first, end, sources, scratch_, control_, stages, index, writer);
        };
        RETURN_IF_ERROR(write(0, coarse));
        RETURN_IF_ERROR(stages.run([&] { return normals_.make(control_); }));
        const int thinned = std::min(levels_, coarse + 1);
        RETURN_IF_ERROR(write(coarse, thinned));
        RETURN_IF_ERROR(stages.run([&] { return heights_.make(control_); }));
        RETURN_IF_ERROR(write(thinned, levels_));
        saturate(index);
        return absl::OkStatus();
    }

    absl::StatusOr<TerrainImportReport> runStages(TerrainStages& stages,
                                                  terrain::EytWriter& writer) {
        RETURN_IF_ERROR(stages.run(
            [&] {
                return parts_ ? parts_->gatherHeights(scratch_, control_, model_)
                              : readElevation(posts_, scratch_, control_, model_);
            },
            readingState(posts_, model_)));
        if (imagery_ == nullptr)  // which is read through the same cache
            scratch_.grow(posts_.release());
        if (model_.statistics.min > model_.statistics.max)
            return noHeights(source_.name, posts_);
        const double postMetres = model_.frame.postMetres();
        const terrain::HeightLattice lattice = chooseHeightLattice(model_.statistics, postMetres);
        vertexLevels_.setThresholds(
            levelThresholds(levels_, postMetres, lattice, options_.errorMetres));
        RETURN_IF_ERROR(stages.run([&] { return makeLevels(); },
                                   {[&] { return vertexLevels_.state(); },
                                    [&](const auto& s) { return vertexLevels_.restore(s); }}));
        terrain::EytIndex index = emptyIndex(model_, lattice, source_.crsWkt, source_.hash);
        RETURN_IF_ERROR(writePages(lattice, stages, index, writer));
        if (index.triangles() == 0)
            return noTriangles(source_.name, model_);
        if (imagery_ != nullptr) {
            const NamedPictures pictures{fmt::format("{}", fmt::join(options_.imagery, ", ")),
                                         stages.areKept() ? pictureStamp(options_.imagery) : 0};
            ASSIGN_OR_RETURN(index.imagery, buildImagery(*imagery_, pictures, parts_, *texels_,
                                                         scratch_, control_, stages, writer));
        }
        ASSIGN_OR_RETURN(const std::uint64_t sizeBytes, writer.commit(index));
        TerrainImportReport report = reportOf(index, postMetres, sizeBytes);
        if (std::string caveat = degreesCaveat(model_.frame, model_.statistics);
            source_.mayBeDegrees && !caveat.empty())
            report.notes.push_back(std::move(caveat));
        for (const auto& notes : {notesOnError(lattice, options_.errorMetres),
                                  notesOnMemory(posts_, imagery_, options_.memoryBytes)})
            report.notes.insert(report.notes.end(), notes.begin(), notes.end());
        return report;
    }

    HeightSource& posts_;
    ImagerySource* imagery_;
    const PartSet* parts_;
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
    const ThreadLimit threads(options.threads);
    OpenImagery imagery;
    if (!options.imagery.empty()) {
        ASSIGN_OR_RETURN(imagery, openImagery(options.imagery, posts.frame(), source.crsWkt,
                                              imageryBytes(posts, options.memoryBytes), control));
    }
    std::optional<PartSet> parts;
    if (options.mergesParts) {
        const PartIdentity identity =
            identityOf(posts.frame(), source.hash, options.errorMetres.value_or(-1),
                       pictureFingerprint(options.imagery), 1);
        absl::StatusOr<PartSet> opened =
            PartSet::open(out, identity, texturesOf(imagery.texels.get()));
        if (absl::IsNotFound(opened.status()))
            return explained(opened.status(), notesOnOutput(out, identity));
        ASSIGN_OR_RETURN(parts, std::move(opened));
    }
    ASSIGN_OR_RETURN(TerrainImportReport report,
                     TerrainJob(posts, imagery.texels.get(), parts ? &*parts : nullptr, source, out,
                                options, control)
                         .run());
    if (parts)
        for (std::string& note : parts->remove()) report.notes.push_back(std::move(note));
    const std::vector<std::string> findings = posts.findings();
    report.notes.insert(report.notes.begin(), findings.begin(), findings.end());
    report.notes.insert(report.notes.end(), imagery.notes.begin(), imagery.notes.end());
    if (imagery.texels) {
        const std::vector<std::string> found = imagery.texels->findings();
        report.notes.insert(report.notes.end(), found.begin(), found.end());
    }
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
    const ThreadLimit threads(options.threads);
    ASSIGN_OR_RETURN(DemSource source,
                     openDems(dems, control, options.mergesParts ? partsFolder(out) : ""));
    const std::string name = dems.size() == 1
                                 ? dems.front()
                                 : fmt::format("{} and {} more", dems.front(), dems.size() - 1);
    absl::StatusOr<TerrainImportReport> report = importTerrain(
        *source.posts, {name, source.crsWkt, source.hash, source.isRounded, source.mayBeDegrees},
        out, options, control);
    if (absl::IsInvalidArgument(report.status()))  // no data, which the findings may explain
        return explained(report.status(), source.posts->findings());
    RETURN_IF_ERROR(report.status());
    report->notes.insert(report->notes.begin(), source.notes.begin(), source.notes.end());
    return report;
}

}  // namespace eyrie::import
