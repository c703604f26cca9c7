// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/layer_reader.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/raster_file.h"

namespace eyrie::import {
namespace {

using terrain::PostRect;

/// About what GDAL warps at once.
constexpr int kBlockColumns = 256;
constexpr int kBlockRows = 128;

constexpr signed char kUnknown = -1;

int blocksOver(int posts, int block) { return (posts + block - 1) / block; }

PostRect common(const PostRect& a, const PostRect& b) {
    const int i = std::max(a.i, b.i);
    const int j = std::max(a.j, b.j);
    return {i, j, std::min(a.i + a.columns, b.i + b.columns) - i,
            std::min(a.j + a.rows, b.j + b.rows) - j};
}

}  // namespace

LayerReader::LayerReader(DemLayer layer) : layer_(std::move(layer)) {
    if (layer_.rimmedWarped)
        isBesideRim_.assign(
            static_cast<std::size_t>(blocksOver(layer_.box.columns, kBlockColumns)) *
                static_cast<std::size_t>(blocksOver(layer_.box.rows, kBlockRows)),
            kUnknown);
}

absl::Status LayerReader::read(const PostRect& window, std::vector<float>& out) {
    RETURN_IF_ERROR(readPosts(layer_.posts(), window, out));
    if (!layer_.rimmedWarped)
        return absl::OkStatus();
    const int endX = blocksOver(window.i + window.columns, kBlockColumns);
    const int endY = blocksOver(window.j + window.rows, kBlockRows);
    for (int y = window.j / kBlockRows; y < endY; ++y)
        for (int x = window.i / kBlockColumns; x < endX; ++x) {
            ASSIGN_OR_RETURN(const bool isBeside, isBesideRim(x, y));
            if (!isBeside)
                continue;
            const PostRect part =
                common(window, {x * kBlockColumns, y * kBlockRows, kBlockColumns, kBlockRows});
            RETURN_IF_ERROR(readPosts(layer_.rimmedWarped.get(), part, rimmed_));
            for (int v = 0; v < part.rows; ++v) {
                const float* from = rimmed_.data() + static_cast<std::ptrdiff_t>(v) * part.columns;
                float* to = out.data() +
                            static_cast<std::ptrdiff_t>(part.j - window.j + v) * window.columns +
                            (part.i - window.i);
                for (int u = 0; u < part.columns; ++u)
                    if (to[u] == to[u] && from[u] == from[u])
                        to[u] = from[u];
            }
        }
    return absl::OkStatus();
}

/// Whether a block, or what is as near to it as a rim tells, is open or ends.
absl::StatusOr<bool> LayerReader::isBesideRim(int x, int y) {
    const PixelBox& box = layer_.box;
    signed char& known =
        isBesideRim_[static_cast<std::size_t>(y) *
                         static_cast<std::size_t>(blocksOver(box.columns, kBlockColumns)) +
                     static_cast<std::size_t>(x)];
    if (known != kUnknown)
        return known != 0;
    const int reach = layer_.rimReach;
    const PostRect around{x * kBlockColumns - reach, y * kBlockRows - reach,
                          kBlockColumns + 2 * reach, kBlockRows + 2 * reach};
    bool isOpen = around.i < 0 || around.j < 0 || around.i + around.columns > box.columns ||
                  around.j + around.rows > box.rows;
    if (!isOpen) {
        RETURN_IF_ERROR(readPosts(layer_.posts(), around, rimmed_));
        isOpen = std::ranges::any_of(rimmed_, [](float h) { return h != h; });
    }
    known = isOpen ? 1 : 0;
    return isOpen;
}

absl::Status LayerReader::readPosts(GDALDatasetH posts, const PostRect& window,
                                    std::vector<float>& out) const {
    out.resize(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows));
    QuietGdal gdal;
    if (GDALRasterIO(GDALGetRasterBand(posts, 1), GF_Read, window.i, window.j, window.columns,
                     window.rows, out.data(), window.columns, window.rows, GDT_Float32, 0,
                     0) == CE_None)
        return absl::OkStatus();
    return absl::DataLossError(fmt::format(
        "{}: rows {} to {} cannot be read ({}); {}", nameOf(layer_.files), window.j,
        window.j + window.rows - 1, gdal.takeError(), whyUnreadable(layer_.files.front().path)));
}

}  // namespace eyrie::import
