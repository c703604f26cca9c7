// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/page_line.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "fabric/status.h"
#include "renderer/terrain/tile_mesh.h"
#include "renderer/terrain/tile_samples.h"

namespace eyrie::import {
namespace {

using terrain::TileId;

float roundedUp(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) >= value
               ? nearest
               : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

std::uint64_t partErrors(const terrain::TileMesh& mesh, double errorMetres, double rounding) {
    std::uint64_t shares = 0;
    int shift = 0;
    for (std::int32_t y = 0; y < terrain::kTilePartsPerSide; ++y)
        for (std::int32_t x = 0; x < terrain::kTilePartsPerSide; ++x) {
            const double error = mesh.errors.metres(x, y);
            shares |= terrain::partShare(error > 0 ? error + rounding : 0, errorMetres) << shift;
            shift += 4;
        }
    return shares;
}

/// A tile's record before its children are known; no heights while min > max.
terrain::TileRecord recordOf(const terrain::TileMesh& mesh, double rounding) {
    terrain::TileRecord record;
    const double error = mesh.errors.greatest();
    record.errorMetres = error > 0 ? roundedUp(error + rounding) : 0;
    record.partErrors = partErrors(mesh, record.errorMetres, rounding);
    record.minHeightMetres = -roundedUp(-mesh.minHeightMetres);
    record.maxHeightMetres = roundedUp(mesh.maxHeightMetres);
    record.triangles = mesh.ownTriangles() & 0x7fffffff;
    record.mixesNodata = mesh.mixesNodata;
    return record;
}

/// Widens a level-0 record to the posts that its triangles leave out.
void coverPosts(const terrain::TileSamples& samples, terrain::TileRecord& record) {
    if (record.triangles == 0)
        return;
    for (const float h : samples.heights()) {
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
                    record.coverErrorsOf(i, finer);
                    record.mixesNodata = record.mixesNodata || finer.mixesNodata;
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
    PageLine(const PageSources& sources, const terrain::Scratch& scratch,
             const ImportControl& control, terrain::EytIndex& index, terrain::EytWriter& writer)
        : sources_(sources),
          scratch_(scratch),
          control_(control),
          index_(index),
          writer_(writer),
          rounding_(sources.model.statistics.highestMagnitude() * terrain::kDeviationRounding),
          workers_([this] { return std::make_unique<Worker>(sources_, index_.quadtree); }) {}

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
    /// What each thread has for itself.
    struct Worker {
        Worker(const PageSources& sources, const terrain::Quadtree& quadtree)
            : surface(sources.model),
              samples(sources.heights, sources.levels),
              mesher(surface, samples, sources.lattice, quadtree) {}

        terrain::SourceSurface surface;
        terrain::TileSamples samples;
        terrain::TileMesher mesher;
        terrain::PageBuilder builder;
    };
    struct BuiltPage {
        std::uint32_t number = 0;
        std::shared_ptr<const std::vector<std::uint32_t>> bytes;
    };

    bool goesOn(std::uint32_t page) {
        if (page >= index_.quadtree.pageCount() || hasFailed_)
            return false;
        cancelled_ = scratch_.status();
        if (cancelled_.ok())
            cancelled_ = control_.check();
        return cancelled_.ok();
    }

    BuiltPage build(std::uint32_t number) {
        Worker& worker = *workers_.local();
        const TileId first = index_.quadtree.firstTileOfPage(number);
        std::vector<std::int8_t> normals;
        for (std::int32_t place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place) {
            const TileId tile{first.level, first.x + place % terrain::kPageTiles,
                              first.y + place / terrain::kPageTiles};
            if (!index_.quadtree.contains(tile))
                continue;
            const terrain::TileMesh& mesh = worker.mesher.mesh(tile);
            terrain::TileRecord record = recordOf(mesh, rounding_);
            if (tile.level == 0)
                coverPosts(worker.samples, record);
            index_.tiles[index_.quadtree.tileIndex(tile)] = record;
            normals.resize(
                hasNormals(tile, mesh, worker.samples) ? terrain::normalMapBytes(tile.level) : 0);
            if (!normals.empty())
                sources_.normals.fill(tile, normals);
            worker.builder.add(place, tile.level, mesh, normals);
        }
        return {number,
                std::make_shared<const std::vector<std::uint32_t>>(worker.builder.finish())};
    }

    /// Where finer tiles share the normals, they may be drawn where this one is not; but only
    /// where there are data.
    bool hasNormals(const TileId& tile, const terrain::TileMesh& mesh,
                    const terrain::TileSamples& samples) const {
        const int level = index_.quadtree.normalLevel();
        return tile.level >= level &&
               (!mesh.indices.empty() || (tile.level == level && samples.hasData()));
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

    const PageSources& sources_;
    const terrain::Scratch& scratch_;
    const ImportControl& control_;
    terrain::EytIndex& index_;
    terrain::EytWriter& writer_;
    double rounding_;
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers_;
    absl::Status status_;  // by the last stage
    std::atomic<bool> hasFailed_ = false;
    absl::Status cancelled_;  // by the first stage
};

}  // namespace

absl::Status buildPages(const PageSources& sources, const terrain::Scratch& scratch,
                        const ImportControl& control, terrain::EytIndex& index,
                        terrain::EytWriter& writer) {
    RETURN_IF_ERROR(PageLine(sources, scratch, control, index, writer).run());
    RETURN_IF_ERROR(scratch.status());
    saturate(index);
    return absl::OkStatus();
}

}  // namespace eyrie::import
