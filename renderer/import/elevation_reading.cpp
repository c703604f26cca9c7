// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/elevation_reading.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

#include <tbb/parallel_pipeline.h>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

using terrain::kRasterTileCells;
using terrain::kRasterTilePosts;

/// Tiles of a strip: what is read at once.
constexpr std::int32_t kStripTiles = 32;

/// Posts of some tiles side by side, cut off at the grid's end.
struct Strip {
    std::int32_t x = 0;  ///< first tile
    std::int32_t y = 0;
    terrain::PostRect rect;
    std::vector<float> posts;
};

/// One tile's posts, past the grid's end its last column and row.
std::shared_ptr<float[]> tileOf(const Strip& strip, std::int32_t firstColumn) {
    auto tile = terrain::TiledRaster<float>::newTile();
    const std::int32_t columns = std::min(kRasterTilePosts, strip.rect.columns - firstColumn);
    for (std::int32_t v = 0; v < kRasterTilePosts; ++v) {
        float* out = tile.get() + v * kRasterTilePosts;
        const float* in =
            strip.posts.data() +
            static_cast<std::ptrdiff_t>(std::min(v, strip.rect.rows - 1)) * strip.rect.columns +
            firstColumn;
        std::fill(std::copy_n(in, columns, out), out + kRasterTilePosts, in[columns - 1]);
    }
    return tile;
}

class Reading {
public:
    Reading(HeightSource& source, const terrain::Scratch& scratch, const ImportControl& control,
            terrain::ElevationModel& model)
        : source_(source), scratch_(scratch), control_(control), model_(model) {}

    absl::Status run() {
        control_.report("reading", 0);
        constexpr std::size_t kStripsAtOnce = 4;
        using StripPointer = std::shared_ptr<Strip>;
        tbb::parallel_pipeline(
            kStripsAtOnce,
            tbb::make_filter<void, StripPointer>(tbb::filter_mode::serial_in_order,
                                                 [&](tbb::flow_control& flow) {
                                                     StripPointer strip = next();
                                                     if (!strip)
                                                         flow.stop();
                                                     return strip;
                                                 }) &
                tbb::make_filter<StripPointer, void>(
                    tbb::filter_mode::parallel, [&](const StripPointer& strip) { store(*strip); }));
        RETURN_IF_ERROR(status_);
        RETURN_IF_ERROR(scratch_.status());
        control_.report("reading", 1);
        return absl::OkStatus();
    }

private:
    /// Null at the end, or when there is no going on.
    std::shared_ptr<Strip> next() {
        const terrain::GridFrame& frame = model_.frame;
        const std::int32_t strips = (model_.heights.tilesX() + kStripTiles - 1) / kStripTiles;
        const std::int32_t rows = model_.heights.tilesY();
        if (next_ == std::int64_t{strips} * rows || !scratch_.status().ok())
            return nullptr;
        status_ = control_.check();
        if (!status_.ok())
            return nullptr;
        auto strip = std::make_shared<Strip>();
        const auto row = static_cast<std::int32_t>(next_ / strips);
        strip->x = static_cast<std::int32_t>(next_ % strips) * kStripTiles;
        strip->y = source_.isLastRowFirst() ? rows - 1 - row : row;
        const std::int32_t i = strip->x * kRasterTileCells;
        const std::int32_t j = strip->y * kRasterTileCells;
        strip->rect = {i, j, std::min(kStripTiles * kRasterTileCells + 1, frame.columns - i),
                       std::min(kRasterTilePosts, frame.rows - j)};
        strip->posts.resize(static_cast<std::size_t>(strip->rect.columns) *
                            static_cast<std::size_t>(strip->rect.rows));
        status_ = source_.read(strip->rect, strip->posts.data());
        if (!status_.ok())
            return nullptr;
        ++next_;
        control_.report("reading",
                        static_cast<double>(next_) / (static_cast<double>(strips) * rows));
        return strip;
    }

    void store(const Strip& strip) {
        terrain::HeightStatistics statistics;
        const std::int32_t end = std::min(strip.x + kStripTiles, model_.heights.tilesX());
        for (std::int32_t x = strip.x; x < end; ++x) {
            auto tile = tileOf(strip, (x - strip.x) * kRasterTileCells);
            model_.relief.add(x, strip.y, tile.get());
            model_.heights.write(x, strip.y, std::move(tile));
        }
        // Borders between tiles are in two strips, and are counted with the latter.
        const bool isLastX = end == model_.heights.tilesX();
        const bool isLastY = strip.y + 1 == model_.heights.tilesY();
        const std::int32_t columns = strip.rect.columns - (isLastX ? 0 : 1);
        for (std::int32_t v = 0; v < strip.rect.rows - (isLastY ? 0 : 1); ++v)
            statistics.add(strip.posts.data() + static_cast<std::ptrdiff_t>(v) * strip.rect.columns,
                           columns);
        const std::lock_guard lock(statisticsMutex_);
        model_.statistics.add(statistics);
    }

    HeightSource& source_;
    const terrain::Scratch& scratch_;
    const ImportControl& control_;
    terrain::ElevationModel& model_;
    std::int64_t next_ = 0;
    absl::Status status_;
    std::mutex statisticsMutex_;
};

}  // namespace

terrain::ElevationModel emptyModel(const terrain::GridFrame& frame, terrain::Scratch& scratch) {
    return {frame,
            {},
            terrain::TiledRaster<float>(scratch, frame.columns, frame.rows),
            terrain::ReliefSummary(frame.columns, frame.rows)};
}

absl::Status readElevation(HeightSource& source, const terrain::Scratch& scratch,
                           const ImportControl& control, terrain::ElevationModel& model) {
    return Reading(source, scratch, control, model).run();
}

}  // namespace eyrie::import
