// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/elevation_reading.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>

#include "fabric/status.h"
#include "renderer/import/lone_posts.h"

namespace eyrie::import {
namespace {

using terrain::kRasterTileCells;
using terrain::kRasterTilePosts;

/// Tiles of a strip, what is read at once, unless the source has fewer columns at once.
constexpr std::int32_t kStripTiles = 32;

/// Posts of some tiles side by side, cut off at the grid's end.
struct Strip {
    std::int32_t x = 0;  ///< first tile
    std::int32_t endX = 0;
    std::int32_t y = 0;
    terrain::PostRect rect;
    std::vector<float> posts;
    std::vector<std::size_t> loneOnBorder;  ///< see lone_posts.h
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
            terrain::ElevationModel& model, const ReadingShare& share)
        : source_(source),
          scratch_(scratch),
          control_(control),
          model_(model),
          share_(share),
          stage_(source.readingStage()),
          tilesAtOnce_(std::max(1, source.columnsAtOnce() / kRasterTileCells)),
          stripTiles_(std::min(kStripTiles, tilesAtOnce_)) {}

    absl::Status run() {
        control_.report(stage_, 0);
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
        control_.report(stage_, 1);
        return absl::OkStatus();
    }

private:
    bool isNeeded(std::int32_t x, std::int32_t y) const {
        return !share_.needed || share_.needed(x, y);
    }

    std::int32_t stripsAcross() const {
        return (model_.heights.tilesX() + stripTiles_ - 1) / stripTiles_;
    }
    double stripCount() const {
        return static_cast<double>(stripsAcross()) * model_.heights.tilesY();
    }
    /// Strips side by side that are read down to the last row before others are.
    std::int32_t stripsAtOnce() const {
        return std::clamp(tilesAtOnce_ / stripTiles_, 1, stripsAcross());
    }
    /// Of the strips in the order in which they are read: column and row.
    std::pair<std::int32_t, std::int32_t> placeOf(std::int64_t strip) const {
        const std::int64_t rows = model_.heights.tilesY();
        const std::int64_t first = strip / (stripsAtOnce() * rows) * stripsAtOnce();
        const std::int64_t across = std::min<std::int64_t>(stripsAtOnce(), stripsAcross() - first);
        const std::int64_t within = strip - first * rows;
        const auto row = static_cast<std::int32_t>(within / across);
        return {static_cast<std::int32_t>(first + within % across),
                source_.isLastRowFirst() ? model_.heights.tilesY() - 1 - row : row};
    }

    /// The next strip, cut down to the tiles that are needed; null at the end.
    std::shared_ptr<Strip> nextNeeded() {
        const std::int64_t strips = std::int64_t{stripsAcross()} * model_.heights.tilesY();
        for (; next_ < strips; ++next_) {
            const auto [column, row] = placeOf(next_);
            auto strip = std::make_shared<Strip>();
            strip->x = column * stripTiles_;
            strip->endX = std::min(strip->x + stripTiles_, model_.heights.tilesX());
            strip->y = row;
            while (strip->x < strip->endX && !isNeeded(strip->x, strip->y)) ++strip->x;
            while (strip->x < strip->endX && !isNeeded(strip->endX - 1, strip->y)) --strip->endX;
            if (strip->x < strip->endX)
                return strip;
        }
        return nullptr;
    }

    /// Null at the end, or when there is no going on.
    std::shared_ptr<Strip> next() {
        const terrain::GridFrame& frame = model_.frame;
        status_ = control_.check();
        if (!status_.ok() || !scratch_.status().ok())
            return nullptr;
        const std::shared_ptr<Strip> strip = nextNeeded();
        if (!strip)
            return nullptr;
        const std::int32_t i = strip->x * kRasterTileCells;
        const std::int32_t j = strip->y * kRasterTileCells;
        strip->rect = {i, j,
                       std::min((strip->endX - strip->x) * kRasterTileCells + 1, frame.columns - i),
                       std::min(kRasterTilePosts, frame.rows - j)};
        strip->posts.resize(static_cast<std::size_t>(strip->rect.columns) *
                            static_cast<std::size_t>(strip->rect.rows));
        status_ = read(*strip);
        if (!status_.ok())
            return nullptr;
        ++next_;
        control_.report(stage_, static_cast<double>(next_) / stripCount());
        return strip;
    }

    absl::Status read(Strip& strip) {
        RETURN_IF_ERROR(source_.read(strip.rect, strip.posts.data()));
        ASSIGN_OR_RETURN(strip.loneOnBorder, lonePostsOnBorder(source_, strip.rect, strip.posts));
        return absl::OkStatus();
    }

    void store(Strip& strip) {
        count(strip);
        dropLonePosts(strip.rect, strip.loneOnBorder, strip.posts);
        for (std::int32_t x = strip.x; x < strip.endX; ++x) {
            if (!isNeeded(x, strip.y))
                continue;
            auto tile = tileOf(strip, (x - strip.x) * kRasterTileCells);
            model_.relief.add(x, strip.y, tile.get());
            model_.heights.write(x, strip.y, std::move(tile));
        }
    }

    /// The source's posts, lone ones among them.
    void count(const Strip& strip) {
        terrain::HeightStatistics statistics;
        for (std::int32_t x = strip.x; x < strip.endX; ++x)
            if (isNeeded(x, strip.y) && (!share_.counted || share_.counted(x, strip.y)))
                countTile(model_.frame, x, strip.y,
                          strip.posts.data() + (x - strip.x) * kRasterTileCells, strip.rect.columns,
                          statistics);
        const std::lock_guard lock(statisticsMutex_);
        model_.statistics.add(statistics);
    }

    HeightSource& source_;
    const terrain::Scratch& scratch_;
    const ImportControl& control_;
    terrain::ElevationModel& model_;
    const ReadingShare& share_;
    const std::string stage_;
    const std::int32_t tilesAtOnce_;  ///< side by side
    const std::int32_t stripTiles_;
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
                           const ImportControl& control, terrain::ElevationModel& model,
                           const ReadingShare& share) {
    return Reading(source, scratch, control, model, share).run();
}

/// First the findings, a line each, to a zero; then the model.
TerrainStages::State readingState(HeightSource& source, terrain::ElevationModel& model) {
    const auto save = [&] {
        std::string lines;
        for (const std::string& finding : source.findings()) lines += finding + '\n';
        lines += '\0';
        std::vector<std::byte> state(lines.size());
        std::memcpy(state.data(), lines.data(), lines.size());
        const std::vector<std::byte> ofModel = model.state();
        state.insert(state.end(), ofModel.begin(), ofModel.end());
        return state;
    };
    const auto restore = [&](const std::vector<std::byte>& state) {
        const auto end = std::ranges::find(state, std::byte{0});
        if (end == state.end() || !model.restore({end + 1, state.end()}))
            return false;
        std::vector<std::string> findings;
        for (auto from = state.begin(); from != end;) {
            const auto to = std::find(from, end, std::byte{'\n'});
            std::string& finding = findings.emplace_back();
            std::transform(from, to, std::back_inserter(finding),
                           [](std::byte b) { return static_cast<char>(b); });
            from = to == end ? end : to + 1;
        }
        source.foundBefore(std::move(findings));
        return true;
    };
    return {save, restore};
}

absl::Status noHeights(const std::string& name, const HeightSource& source) {
    const std::vector<std::string> findings = source.findings();
    return absl::InvalidArgumentError(
        findings.empty()
            ? fmt::format("{}: all posts are nodata; check the nodata value", name)
            : fmt::format("{}: all posts are nodata: {}; check the nodata value, scale and offset",
                          name, findings.front()));
}

void countTile(const terrain::GridFrame& frame, std::int32_t x, std::int32_t y, const float* posts,
               std::ptrdiff_t stride, terrain::HeightStatistics& statistics) {
    const auto own = [](std::int32_t all, std::int32_t tile) {
        const std::int32_t left = all - tile * kRasterTileCells;
        return left <= kRasterTilePosts ? left : kRasterTileCells;  // the last has its end, too
    };
    for (std::int32_t v = 0; v < own(frame.rows, y); ++v)
        statistics.add(posts + v * stride, own(frame.columns, x));
}

}  // namespace eyrie::import
