// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_shard.h"

#include <cerrno>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fabric/replaceable.h"
#include "fabric/status.h"
#include "renderer/import/dem_source.h"
#include "renderer/import/elevation_reading.h"
#include "renderer/import/file_hash.h"
#include "renderer/import/imagery_pages.h"
#include "renderer/import/imagery_source.h"
#include "renderer/import/page_line.h"
#include "renderer/import/picture_fingerprint.h"
#include "renderer/import/shard_facts.h"
#include "renderer/import/shard_part.h"
#include "renderer/import/terrain_choices.h"
#include "renderer/import/terrain_stages.h"
#include "renderer/import/thread_limit.h"

namespace eyrie::import {
namespace {

absl::Status makeFolder(const std::string& folder) {
    if (mkdir(folder.c_str(), 0755) == 0 || errno == EEXIST)
        return absl::OkStatus();
    return fabric::writeError(folder, "cannot be made", errno);
}

/// One shard: what it holds, and its stages. Rasters are of the whole grid, filled where the shard
/// has something to do with it.
class ShardJob {
public:
    /// `imagery` may be null.
    ShardJob(HeightSource& posts, ImagerySource* imagery, const TerrainSource& source,
             const std::string& out, const Shard& shard, const TerrainImportOptions& options,
             const ImportControl& control)
        : posts_(posts),
          imagery_(imagery),
          source_(source),
          out_(out),
          shard_(shard),
          options_(options),
          control_(control),
          quadtree_(static_cast<std::uint32_t>(posts.frame().columns),
                    static_cast<std::uint32_t>(posts.frame().rows)),
          plan_(quadtree_, shard.count, texturesOf(imagery)),
          identity_(identityOf(posts.frame(), source.hash, options.errorMetres.value_or(-1),
                               pictureFingerprint(options.imagery), shard.count)),
          path_(partPath(out, shard)),
          scratch_(scratchPath(path_, options.scratchFolder),
                   scratchBytes(posts, imagery, options.memoryBytes)),
          model_(emptyModel(posts.frame(), scratch_)),
          heights_(model_, scratch_, 1),
          normals_(model_, scratch_, 1),
          vertexLevels_(model_, scratch_) {}

    absl::StatusOr<TerrainShardReport> run() {
        if (!options_.startsOver)
            if (const absl::StatusOr<PartFile> part =
                    PartFile::open(path_, identity_, shard_, plan_);
                part.ok() && part->verify().ok()) {
                TerrainStages::removeLeftovers(scratch_.path());  // killed since it was whole
                return report(part->sizeBytes(), true);
            }
        ASSIGN_OR_RETURN(
            TerrainStages stages,
            TerrainStages::open(scratch_, scratchPath(path_, ""),
                                stagesKey(identity_, shard_.index), options_.startsOver));
        const absl::StatusOr<std::uint64_t> sizeBytes = runStages(stages);
        RETURN_IF_ERROR(stages.end(sizeBytes.status()));
        return report(*sizeBytes, false);
    }

private:
    TerrainShardReport report(std::uint64_t sizeBytes, bool wasThere) const {
        std::uint64_t posts = 0;
        for (const std::uint32_t tile : plan_.tilesOf(shard_.index)) {
            const auto own = [](std::int32_t all, std::int32_t first) {
                const std::int32_t left = all - first * terrain::kRasterTileCells;
                return static_cast<std::uint64_t>(
                    left <= terrain::kRasterTilePosts ? left : terrain::kRasterTileCells);
            };
            const auto number = static_cast<std::int32_t>(tile);
            posts += own(model_.frame.columns, number % plan_.tilesX()) *
                     own(model_.frame.rows, number / plan_.tilesX());
        }
        return {path_,
                posts,
                plan_.pagesOf(shard_.index).size(),
                plan_.texturesOf(shard_.index).size(),
                sizeBytes,
                wasThere,
                notesOnMemory(posts_, imagery_, options_.memoryBytes)};
    }

    absl::Status read() {
        return readElevation(posts_, scratch_, control_, model_,
                             {needed_, [&](std::int32_t x, std::int32_t y) {
                                  return plan_.ownerOfTile(x, y) == shard_.index;
                              }});
    }

    absl::Status joinLevels() {
        RETURN_IF_ERROR(vertexLevels_.join(control_, needed_));
        return vertexLevels_.finish(control_, terrain::VertexLevels::kTileSpacing);
    }

    absl::StatusOr<std::uint64_t> runStages(TerrainStages& stages) {
        RETURN_IF_ERROR(stages.run([&] { return read(); }, readingState(posts_, model_)));
        // Another shard that could not begin may have removed it, while it was empty.
        RETURN_IF_ERROR(makeFolder(partsFolder(out_)));
        ASSIGN_OR_RETURN(model_.statistics, shareFacts(out_, identity_, plan_, shard_,
                                                       model_.statistics, posts_, control_));
        if (model_.statistics.min > model_.statistics.max)
            return noHeights(source_.name, posts_);
        const double postMetres = model_.frame.postMetres();
        const terrain::HeightLattice lattice = chooseHeightLattice(model_.statistics, postMetres);
        vertexLevels_.setThresholds(
            levelThresholds(quadtree_.levels(), postMetres, lattice, options_.errorMetres));
        RETURN_IF_ERROR(stages.run([&] { return vertexLevels_.measure(control_, needed_); }));
        RETURN_IF_ERROR(stages.run([&] { return joinLevels(); },
                                   {[&] { return vertexLevels_.state(); },
                                    [&](const auto& s) { return vertexLevels_.restore(s); }}));
        return writePart(lattice);
    }

    absl::StatusOr<std::uint64_t> writePart(const terrain::HeightLattice& lattice) {
        ASSIGN_OR_RETURN(PartWriter writer,
                         PartWriter::create(path_, identity_, shard_, model_.statistics));
        for (const std::uint32_t tile : plan_.tilesOf(shard_.index)) {
            const std::int32_t x = static_cast<std::int32_t>(tile) % plan_.tilesX();
            const std::int32_t y = static_cast<std::int32_t>(tile) / plan_.tilesX();
            RETURN_IF_ERROR(writer.addTile(model_.heights.tile(x, y).get(),
                                           vertexLevels_.measured(x, y).get()));
        }
        terrain::EytIndex index = emptyIndex(model_, lattice, source_.crsWkt, source_.hash);
        const auto sink = [&](std::uint32_t page, std::span<const std::uint32_t> bytes) {
            PageTiles tiles{};
            forEachTileOfPage(quadtree_, page, [&](const terrain::TileId& tile, int place) {
                tiles[static_cast<std::size_t>(place)] = index.tile(tile);
            });
            return writer.addPage(tiles, bytes);
        };
        RETURN_IF_ERROR(
            buildPages({model_, heights_, vertexLevels_, normals_, lattice, source_.isRounded},
                       plan_.pagesOf(shard_.index), scratch_, control_, index, sink));
        if (imagery_ != nullptr)
            RETURN_IF_ERROR(buildTextures(*imagery_, plan_.texturesOf(shard_.index), control_,
                                          [&](std::size_t k, const TexturePiece& texture) {
                                              return writer.addTexture(k, texture);
                                          }));
        return writer.commit();
    }

    HeightSource& posts_;
    ImagerySource* imagery_;
    const TerrainSource& source_;
    const std::string& out_;
    const Shard shard_;
    const TerrainImportOptions& options_;
    const ImportControl& control_;
    terrain::Quadtree quadtree_;
    ShardPlan plan_;
    PartIdentity identity_;
    std::string path_;
    const terrain::TileFilter needed_ = [this](std::int32_t x, std::int32_t y) {
        return plan_.isNear(shard_.index, x, y);
    };
    terrain::Scratch scratch_;
    terrain::ElevationModel model_;
    terrain::HeightLayers heights_;  ///< levels 0 to 2 have every post: nothing to make
    terrain::NormalMaps normals_;    ///< nor to smooth
    terrain::VertexLevels vertexLevels_;
};

absl::Status check(const std::string& out, const Shard& shard) {
    if (shard.count >= 1 && shard.count <= kMaxShards && shard.index < shard.count)
        return fabric::checkReplaceable(out);
    return absl::InvalidArgumentError(
        fmt::format("shard {}/{} does not exist; of N shards, at most {}, the first is 0/N and "
                    "the last N-1/N",
                    shard.index, shard.count, kMaxShards));
}

/// Notes the hashes of large files for openDems. Each shard begins elsewhere, so that those that
/// start together do not all read the same file.
absl::Status noteHashes(const std::vector<std::string>& dems, const Shard& shard,
                        const std::string& folder, const ImportControl& control) {
    const std::size_t first = dems.size() * shard.index / shard.count;
    for (std::size_t k = 0; k < dems.size(); ++k) {
        RETURN_IF_ERROR(control.check());
        control.report("checking", static_cast<double>(k) / static_cast<double>(dems.size()));
        noteHash(dems[(first + k) % dems.size()], folder, control.stop);
    }
    return absl::OkStatus();
}

absl::StatusOr<DemSource> openShared(const std::vector<std::string>& dems, const Shard& shard,
                                     const std::string& folder, const ImportControl& control) {
    RETURN_IF_ERROR(noteHashes(dems, shard, folder, control));
    return openDems(dems, control, folder);
}

}  // namespace

absl::StatusOr<TerrainShardReport> importTerrainShard(HeightSource& posts,
                                                      const TerrainSource& source,
                                                      const std::string& out, const Shard& shard,
                                                      const TerrainImportOptions& options,
                                                      const ImportControl& control) {
    const ThreadLimit threads(options.threads);
    RETURN_IF_ERROR(check(out, shard));
    OpenImagery imagery;
    if (!options.imagery.empty()) {
        ASSIGN_OR_RETURN(imagery, openImagery(options.imagery, posts.frame(), source.crsWkt,
                                              imageryBytes(posts, options.memoryBytes), control));
    }
    RETURN_IF_ERROR(makeFolder(partsFolder(out)));
    ASSIGN_OR_RETURN(
        TerrainShardReport report,
        ShardJob(posts, imagery.texels.get(), source, out, shard, options, control).run());
    const std::vector<std::string> findings = posts.findings();
    report.notes.insert(report.notes.begin(), findings.begin(), findings.end());
    report.notes.insert(report.notes.end(), imagery.notes.begin(), imagery.notes.end());
    if (imagery.texels) {
        const std::vector<std::string> found = imagery.texels->findings();
        report.notes.insert(report.notes.end(), found.begin(), found.end());
    }
    return report;
}

absl::StatusOr<TerrainShardReport> importTerrainShard(const std::vector<std::string>& dems,
                                                      const std::string& out, const Shard& shard,
                                                      const TerrainImportOptions& options,
                                                      const ImportControl& control) {
    RETURN_IF_ERROR(check(out, shard));
    const ThreadLimit threads(options.threads);
    const std::string folder = partsFolder(out);
    RETURN_IF_ERROR(makeFolder(folder));
    absl::StatusOr<DemSource> opened = openShared(dems, shard, folder, control);
    if (!opened.ok())
        rmdir(folder.c_str());  // unless there is something in it
    ASSIGN_OR_RETURN(const DemSource source, std::move(opened));
    const std::string name = dems.size() == 1
                                 ? dems.front()
                                 : fmt::format("{} and {} more", dems.front(), dems.size() - 1);
    ASSIGN_OR_RETURN(
        TerrainShardReport report,
        importTerrainShard(*source.posts, {name, source.crsWkt, source.hash, source.isRounded}, out,
                           shard, options, control));
    report.notes.insert(report.notes.begin(), source.notes.begin(), source.notes.end());
    return report;
}

}  // namespace eyrie::import
