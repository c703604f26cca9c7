// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/layer_reader.h"

#include <algorithm>
#include <cstddef>
#include <optional>
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

int blocksOver(int posts, int block) { return (posts + block - 1) / block; }

PostRect blockAt(int x, int y) {
    return {x * kBlockColumns, y * kBlockRows, kBlockColumns, kBlockRows};
}

PostRect common(const PostRect& a, const PostRect& b) {
    const int i = std::max(a.i, b.i);
    const int j = std::max(a.j, b.j);
    return {i, j, std::min(a.i + a.columns, b.i + b.columns) - i,
            std::min(a.j + a.rows, b.j + b.rows) - j};
}

}  // namespace

LayerReader::LayerReader(DemLayer layer) : layer_(std::move(layer)) {
    if (layer_.rimmedWarped)
        blocks_.resize(static_cast<std::size_t>(blocksOver(layer_.box.columns, kBlockColumns)) *
                       static_cast<std::size_t>(blocksOver(layer_.box.rows, kBlockRows)));
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
            const PostRect part = common(window, blockAt(x, y));
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

LayerReader::Block& LayerReader::blockOf(int x, int y) {
    return blocks_[static_cast<std::size_t>(y) *
                       static_cast<std::size_t>(blocksOver(layer_.box.columns, kBlockColumns)) +
                   static_cast<std::size_t>(x)];
}

/// Whether a block, or one that is as near to it as a rim tells, has gaps or is at the layer's end.
/// That reach may be many blocks, where the layer's pixels are far wider than posts.
absl::StatusOr<bool> LayerReader::isBesideRim(int x, int y) {
    std::optional<bool>& known = blockOf(x, y).isBesideRim;
    if (known)
        return *known;
    const PixelBox& box = layer_.box;
    const int reach = layer_.rimReach;
    const PostRect block = blockAt(x, y);
    const int endI = block.i + block.columns + reach, endJ = block.j + block.rows + reach;
    bool isBeside = block.i < reach || block.j < reach || endI > box.columns || endJ > box.rows;
    for (int v = (block.j - reach) / kBlockRows; !isBeside && v * kBlockRows < endJ; ++v)
        for (int u = (block.i - reach) / kBlockColumns; !isBeside && u * kBlockColumns < endI;
             ++u) {
            ASSIGN_OR_RETURN(isBeside, hasGaps(u, v));
        }
    known = isBeside;
    return isBeside;
}

/// Whether posts of a block have no height. Each block is read once for that, however many are
/// near it.
absl::StatusOr<bool> LayerReader::hasGaps(int x, int y) {
    std::optional<bool>& known = blockOf(x, y).hasGaps;
    if (!known) {
        const PostRect all{0, 0, layer_.box.columns, layer_.box.rows};
        RETURN_IF_ERROR(readPosts(layer_.posts(), common(all, blockAt(x, y)), rimmed_));
        known = std::ranges::any_of(rimmed_, [](float h) { return h != h; });
    }
    return *known;
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
