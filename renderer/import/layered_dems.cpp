// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/layered_dems.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <malloc.h>

#include "fabric/scene_reach.h"
#include "fabric/status.h"
#include "renderer/import/layer_reader.h"
#include "renderer/terrain/quadtree.h"

namespace eyrie::import {
namespace {

using fabric::Vec2;

/// As many digits as the file's own type has.
std::string digitsOf(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest == value ? fmt::format("{}", nearest) : fmt::format("{}", value);
}

/// Of a row of blocks, for each column.
std::int64_t blockBytesOfColumn(const Dataset& heights) {
    if (!heights)
        return 0;
    int columns = 0, rows = 0;
    GDALGetBlockSize(GDALGetRasterBand(heights.get(), 1), &columns, &rows);
    return std::int64_t{rows} * std::int64_t{sizeof(float)};
}

/// How many columns GDAL's cache holds two rows of blocks of: what is read at once may end within
/// blocks. All, where wider files are stored in rows; of blocks without room those of the widest.
std::int32_t columnsHeld(const std::vector<DemLayer>& layers, std::int32_t all) {
    std::int64_t ofColumns = 0, ofEdge = 0;  // bytes
    std::int64_t widestBlock = 1, widestRow = 0;
    for (const DemLayer& layer : layers) {
        std::int64_t ofFiles = 0;
        for (const DemFile& file : layer.files) {
            widestBlock = std::max<std::int64_t>(widestBlock, file.blockColumns);
            if (file.blockColumns >= file.columns)
                widestRow = std::max<std::int64_t>(widestRow, file.columns);
            const std::int64_t ofFile = std::int64_t{file.blockRows} * file.valueBytes;
            ofFiles = std::max(ofFiles, ofFile);
            ofEdge = std::max(ofEdge, ofFile * file.blockColumns);
        }
        ofColumns += ofFiles + blockBytesOfColumn(layer.joined) + blockBytesOfColumn(layer.warped);
    }
    const std::int64_t room = std::int64_t{kGdalCacheBytes} / 2 - ofEdge;
    const std::int64_t held =
        std::clamp<std::int64_t>(room / ofColumns, std::min<std::int64_t>(widestBlock, all), all);
    return widestRow > held ? all : static_cast<std::int32_t>(held);
}

/// `out` rows from the last to the first where the raster's first row is the frame's last.
class LayeredSource : public HeightSource {
public:
    /// Best layer first. `reference` is in metres, of a raster of columns x rows.
    LayeredSource(std::vector<DemLayer> layers, const Georeference& reference, int columns,
                  int rows)
        : isFlipped_(determinant(reference) < 0) {
        columnsAtOnce_ = columnsHeld(layers, columns);
        for (DemLayer& layer : layers) layers_.emplace_back(std::move(layer));
        frame_ = {columns, rows, reference.origin + (reference.perColumn + reference.perRow) * 0.5,
                  reference.perColumn, reference.perRow};
        if (!isFlipped_)
            return;
        frame_.origin += reference.perRow * static_cast<double>(rows - 1);
        frame_.perRow = Vec2(0.0) - reference.perRow;  // no negative zeros
    }

    const terrain::GridFrame& frame() const override { return frame_; }
    bool isLastRowFirst() const override { return isFlipped_; }
    std::int32_t columnsAtOnce() const override { return columnsAtOnce_; }

    absl::Status read(const terrain::PostRect& window, float* out) override {
        const auto count =
            static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows);
        std::fill_n(out, count, terrain::kNodata);
        bool isFirst = true;
        for (LayerReader& layer : layers_) {
            if (!meets(layer, window))
                continue;
            if (!isFirst && std::none_of(out, out + count, [](float h) { return h != h; }))
                break;
            RETURN_IF_ERROR(addLayer(layer, window, out));
            isFirst = false;
        }
        constexpr int kReadsAtOnce = 16;
        if (++reads_ % kReadsAtOnce == 0)
            malloc_trim(0);  // or the heap keeps what was freed: some 90 MiB, warping
        return absl::OkStatus();
    }

    std::string readingStage() const override {
        std::size_t all = 0;
        std::size_t resampled = 0;
        for (const LayerReader& reader : layers_) {
            all += reader.layer().files.size();
            resampled += reader.layer().warped ? reader.layer().files.size() : 0;
        }
        if (resampled == 0)
            return "reading";
        return resampled == all
                   ? "reading and resampling"
                   : fmt::format("reading and resampling {} of {} rasters", resampled, all);
    }

    std::uint64_t readingBytes() const override {
        constexpr std::uint64_t kWarping = std::uint64_t{40} << 20;  // measured
        return std::ranges::any_of(layers_,
                                   [](const auto& each) { return bool{each.layer().warped}; })
                   ? kWarping
                   : 0;
    }

    std::vector<std::string> findings() const override {
        std::vector<std::string> findings = findings_;
        for (const LayerReader& reader : layers_)
            for (const DemFile& file : reader.layer().files)
                if (const auto& found = *file.impossible)
                    findings.push_back(fmt::format(
                        "{} in column {} and row {} of {} can be no height; it is taken for "
                        "nodata, and so is what else is like it",
                        digitsOf(found->value), found->column, found->row, file.path));
        return findings;
    }

    void foundBefore(std::vector<std::string> findings) override {
        findings_ = std::move(findings);
    }

    std::uint64_t release() override {
        findings_ = findings();
        layers_.clear();
        buffer_ = {};
        malloc_trim(0);              // blocks are small: the heap would keep them
        return kGdalCacheBytes / 2;  // so much less the process holds: measured
    }

private:
    int firstRowOf(const terrain::PostRect& window) const {
        return isFlipped_ ? frame_.rows - window.j - window.rows : window.j;
    }

    bool meets(const LayerReader& reader, const terrain::PostRect& window) const {
        const PixelBox& box = reader.layer().box;
        const int firstRow = firstRowOf(window);
        return box.column < window.i + window.columns && box.column + box.columns > window.i &&
               box.row < firstRow + window.rows && box.row + box.rows > firstRow;
    }

    /// Fills in what is nodata so far. Precondition: the layer meets the window.
    absl::Status addLayer(LayerReader& reader, const terrain::PostRect& window, float* out) {
        const int firstRow = firstRowOf(window);
        const PixelBox& box = reader.layer().box;
        const int i0 = std::max(window.i, static_cast<int>(box.column));
        const int j0 = std::max(firstRow, static_cast<int>(box.row));
        const int i1 =
            std::min(window.i + window.columns, static_cast<int>(box.column) + box.columns);
        const int j1 = std::min(firstRow + window.rows, static_cast<int>(box.row) + box.rows);
        const terrain::PostRect part{i0 - static_cast<int>(box.column),
                                     j0 - static_cast<int>(box.row), i1 - i0, j1 - j0};
        RETURN_IF_ERROR(reader.read(part, buffer_));
        constexpr float kImpossible = 1e30F;
        for (int v = 0; v < part.rows; ++v) {
            const int row = isFlipped_ ? window.rows - 1 - (j0 - firstRow + v) : j0 - firstRow + v;
            float* to = out + static_cast<std::ptrdiff_t>(row) * window.columns + (i0 - window.i);
            const float* from = buffer_.data() + static_cast<std::ptrdiff_t>(v) * part.columns;
            for (int u = 0; u < part.columns; ++u)
                if (to[u] != to[u] && std::abs(from[u]) < kImpossible)
                    to[u] = from[u];
        }
        return absl::OkStatus();
    }

    std::vector<LayerReader> layers_;
    int reads_ = 0;
    bool isFlipped_;
    std::int32_t columnsAtOnce_;
    terrain::GridFrame frame_;
    std::vector<float> buffer_;
    std::vector<std::string> findings_;  ///< before, and in layers that have been released
};

}  // namespace

std::string nameOf(const std::vector<DemFile>& files) {
    return files.size() == 1 ? files.front().path
                             : fmt::format("{} and {} more", files.front().path, files.size() - 1);
}

double determinant(const Georeference& g) {
    return g.perColumn.x * g.perRow.y - g.perColumn.y * g.perRow.x;
}

absl::Status checkSize(const std::string& path, std::int64_t columns, std::int64_t rows,
                       const std::string& grid) {
    if (columns < 2 || rows < 2)
        return invalid(path, fmt::format("has {} x {} posts{}; a terrain needs at least 2 x 2",
                                         columns, rows, grid));
    constexpr std::int64_t kMaxSide = terrain::kMaxPosts;
    if (columns > kMaxSide || rows > kMaxSide ||
        static_cast<std::uint64_t>(columns * rows) > terrain::kMaxGridPosts)
        return absl::ResourceExhaustedError(
            fmt::format("{}: has {} x {} posts{}; the limits are {} posts a side and {} in all; "
                        "import a part of "
                        "it (gdal_translate -srcwin) or fewer posts (-outsize)",
                        path, columns, rows, grid, kMaxSide, terrain::kMaxGridPosts));
    return absl::OkStatus();
}

absl::Status checkReach(const std::string& path, const terrain::GridFrame& frame) {
    constexpr double kMost = fabric::kMaxSceneMetres;
    const Vec2 across = frame.perColumn * static_cast<double>(frame.columns - 1);
    const Vec2 along = frame.perRow * static_cast<double>(frame.rows - 1);
    for (const Vec2& step : {Vec2(0.0), across, along, across + along})
        for (const double metres : {frame.origin.x + step.x, frame.origin.y + step.y})
            if (!(std::abs(metres) <= kMost))
                return invalid(path,
                               fmt::format("reaches to {:.3g} metres; scenes reach from {:g} to "
                                           "{:g}: give it the right georeference (gdal_edit.py "
                                           "-a_ullr)",
                                           metres, -kMost, kMost));
    return absl::OkStatus();
}

std::unique_ptr<HeightSource> layeredDems(std::vector<DemLayer> layers,
                                          const Georeference& reference, int columns, int rows) {
    return std::make_unique<LayeredSource>(std::move(layers), reference, columns, rows);
}

}  // namespace eyrie::import
