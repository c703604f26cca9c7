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
#include "renderer/terrain/eyt_writer.h"
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

/// What may be missing in an error that was reckoned.
struct Rounding {
    double ofErrors = 0;   ///< of one that is not 0
    double ofHeights = 0;  ///< of posts before all else

    double with(double error) const { return error > 0 ? error + ofErrors + ofHeights : ofHeights; }
};

/// Of floats that are the nearest ones, for a height of 1.
constexpr double kFloatRounding = 1.0 / (1 << 24);

void setPartErrors(const terrain::TileMesh& mesh, const Rounding& rounding,
                   terrain::TileRecord& record) {
    for (std::int32_t y = 0; y < terrain::kTilePartsPerSide; ++y) {
        int shares = 0;
        for (std::int32_t x = 0; x < terrain::kTilePartsPerSide; ++x) {
            const double error = rounding.with(mesh.errors.metres(x, y));
            shares |= terrain::partShare(error, record.errorMetres) << 4 * x;
        }
        record.partErrors[static_cast<std::size_t>(y)] = static_cast<std::uint16_t>(shares);
    }
}

/// A tile's record before its children are known; no heights while min > max.
terrain::TileRecord recordOf(const terrain::TileMesh& mesh, const Rounding& rounding) {
    terrain::TileRecord record;
    record.errorMetres = roundedUp(rounding.with(mesh.errors.greatest()));
    record.outlineMetres = roundedUp(mesh.outlineMetres);
    record.nodataParts = mesh.nodataParts;
    setPartErrors(mesh, rounding, record);
    record.minHeightMetres = -roundedUp(-mesh.minHeightMetres);
    record.maxHeightMetres = roundedUp(mesh.maxHeightMetres);
    record.triangles = static_cast<std::uint16_t>(mesh.ownTriangles());
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

/// Builds pages in parallel and writes them in order.
class PageLine {
public:
    PageLine(const PageSources& sources, std::span<const std::uint32_t> pages,
             const terrain::Scratch& scratch, const ImportControl& control,
             terrain::EytIndex& index, const PageSink& sink)
        : sources_(sources),
          pages_(pages),
          scratch_(scratch),
          control_(control),
          index_(index),
          sink_(sink),
          rounding_(roundingOf(sources)),
          workers_([this] { return std::make_unique<Worker>(sources_, index_.quadtree); }) {}

    absl::Status run() {
        std::size_t next = 0;
        const auto tokens = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
        tbb::parallel_pipeline(
            tokens,
            tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                                [&](tbb::flow_control& flow) {
                                                    if (!goesOn(next))
                                                        flow.stop();
                                                    return next++;
                                                }) &
                tbb::make_filter<std::size_t, BuiltPage>(
                    tbb::filter_mode::parallel, [&](std::size_t k) { return make(pages_[k]); }) &
                tbb::make_filter<BuiltPage, void>(tbb::filter_mode::serial_in_order,
                                                  [&](const BuiltPage& page) { handOver(page); }));
        return cancelled_.ok() ? status_ : cancelled_;
    }

private:
    static Rounding roundingOf(const PageSources& sources) {
        const double highest = sources.model.statistics.highestMagnitude();
        // Floats hold whole numbers only up to 2^24.
        const bool isRounded = sources.isRounded || highest * kFloatRounding > 1;
        return {highest * terrain::kDeviationRounding, isRounded ? highest * kFloatRounding : 0};
    }

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
        absl::Status status;
    };

    bool goesOn(std::size_t page) {
        if (page >= pages_.size() || hasFailed_)
            return false;
        cancelled_ = scratch_.status();
        if (cancelled_.ok())
            cancelled_ = control_.check();
        return cancelled_.ok();
    }

    BuiltPage make(std::uint32_t number) {
        const bool isBuilt = sources_.parts != nullptr && sources_.parts->hasPage(number);
        return isBuilt ? take(number) : build(number);
    }

    BuiltPage take(std::uint32_t number) {
        PageTiles records;
        absl::StatusOr<std::vector<std::uint32_t>> bytes =
            sources_.parts->readPage(number, records);
        if (!bytes.ok())
            return {number, nullptr, bytes.status()};
        forEachTileOfPage(index_.quadtree, number, [&](const TileId& tile, int place) {
            index_.tiles[index_.quadtree.tileIndex(tile)] =
                records[static_cast<std::size_t>(place)];
        });
        return {number, std::make_shared<const std::vector<std::uint32_t>>(*std::move(bytes)), {}};
    }

    BuiltPage build(std::uint32_t number) {
        Worker& worker = *workers_.local();
        std::vector<std::int8_t> normals;
        forEachTileOfPage(index_.quadtree, number, [&](const TileId& tile, int place) {
            const terrain::TileMesh& mesh = worker.mesher.mesh(tile);
            terrain::TileRecord record =
                recordOf(mesh, mesh.ownTriangles() > 0 ? rounding_ : Rounding{});
            if (tile.level == 0)
                coverPosts(worker.samples, record);
            index_.tiles[index_.quadtree.tileIndex(tile)] = record;
            normals.resize(
                hasNormals(tile, mesh, worker.samples) ? terrain::normalMapBytes(tile.level) : 0);
            if (!normals.empty())
                sources_.normals.fill(tile, normals);
            worker.builder.add(place, tile.level, mesh, normals);
        });
        return {number,
                std::make_shared<const std::vector<std::uint32_t>>(worker.builder.finish()),
                {}};
    }

    /// Where finer tiles share the normals, they may be drawn where this one is not; but only
    /// where there are data.
    bool hasNormals(const TileId& tile, const terrain::TileMesh& mesh,
                    const terrain::TileSamples& samples) const {
        const int level = index_.quadtree.normalLevel();
        return tile.level >= level &&
               (!mesh.indices.empty() || (tile.level == level && samples.hasData()));
    }

    void handOver(const BuiltPage& page) {
        if (hasFailed_)
            return;
        status_ = page.status.ok() ? sink_(page.number, *page.bytes) : page.status;
        hasFailed_ = !status_.ok();
        ++done_;
        control_.report("building",
                        static_cast<double>(done_) / static_cast<double>(pages_.size()));
    }

    const PageSources& sources_;
    std::span<const std::uint32_t> pages_;
    const terrain::Scratch& scratch_;
    const ImportControl& control_;
    terrain::EytIndex& index_;
    const PageSink& sink_;
    Rounding rounding_;
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers_;
    std::size_t done_ = 0;
    absl::Status status_;  // by the last stage
    std::atomic<bool> hasFailed_ = false;
    absl::Status cancelled_;  // by the first stage
};

}  // namespace

absl::Status buildPages(const PageSources& sources, std::span<const std::uint32_t> pages,
                        const terrain::Scratch& scratch, const ImportControl& control,
                        terrain::EytIndex& index, const PageSink& sink) {
    RETURN_IF_ERROR(PageLine(sources, pages, scratch, control, index, sink).run());
    return scratch.status();
}

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
                    record.minHeightMetres =
                        std::min(record.minHeightMetres, finer.minHeightMetres);
                    record.maxHeightMetres =
                        std::max(record.maxHeightMetres, finer.maxHeightMetres);
                }
            }
    for (terrain::TileRecord& record : index.tiles)
        if (record.minHeightMetres > record.maxHeightMetres)
            record = {.nodataParts = record.nodataParts};  // no triangle here in any level
}

}  // namespace eyrie::import
