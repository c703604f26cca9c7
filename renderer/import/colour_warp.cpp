// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/colour_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "fabric/status.h"
#include "renderer/import/thread_limit.h"

namespace eyrie::import {
namespace {

using Transformer = std::unique_ptr<void, Releaser<GDALDestroyTransformer>>;
using Options = std::unique_ptr<char*, Releaser<CSLDestroy>>;
using WarpOptions = std::unique_ptr<GDALWarpOptions, Releaser<GDALDestroyWarpOptions>>;

constexpr int kColours = 3;
constexpr double kTransformPixels = 0.125;  ///< of the picture, that a transform may be off

absl::Status cannotBeBrought(const ColourFile& file, QuietGdal& gdal) {
    return invalid(file.path, fmt::format("cannot be brought to the terrain's CRS ({}); reproject "
                                          "it with gdalwarp first",
                                          gdal.takeError()));
}

/// The file's pixels in the terrain's CRS, without a reprojection where either has none.
absl::StatusOr<Transformer> transformerOf(const ColourFile& file, const TexelGrid& grid,
                                          QuietGdal& gdal) {
    Options options;
    if (grid.crs && file.crs) {
        options.reset(CSLSetNameValue(options.release(), "SRC_SRS", wktOf(file.crs.get()).c_str()));
        options.reset(CSLSetNameValue(options.release(), "DST_SRS", wktOf(grid.crs.get()).c_str()));
    }
    Transformer transformer(
        GDALCreateGenImgProjTransformer2(file.dataset.get(), nullptr, options.get()));
    if (!transformer)
        return cannotBeBrought(file, gdal);
    return transformer;
}

/// The whole terrain, each post the middle of a cell, with the picture's north on the terrain's.
Georeference stretched(const TexelGrid& grid, int columns, int rows) {
    const terrain::GridFrame& frame = grid.frame;
    const fabric::Vec2 across = frame.perColumn * static_cast<double>(frame.columns);
    const fabric::Vec2 up = frame.perRow * static_cast<double>(frame.rows);
    const fabric::Vec2 corner = frame.origin - (frame.perColumn + frame.perRow) * 0.5;
    return {corner + up, across / static_cast<double>(columns), up / -static_cast<double>(rows)};
}

fabric::Vec2 postOf(const fabric::Vec2& point, const terrain::GridFrame& frame) {
    const glm::dmat2 pointFromPost(frame.perColumn, frame.perRow);
    return glm::inverse(pointFromPost) * (point - frame.origin);
}

/// The shorter sides of pixels that were looked at.
struct Sides {
    double squares = 0;  ///< summed, of posts
    int count = 0;

    void add(double side) {
        squares += side * side;
        ++count;
    }
    double mean() const { return std::sqrt(squares / count); }
};

bool isWithin(const fabric::Vec2& at, const fabric::Vec2& low, const fabric::Vec2& high) {
    return at.x >= low.x && at.y >= low.y && at.x <= high.x && at.y <= high.y;
}

}  // namespace

Georeference TexelGrid::reference(int texelShift) const {
    const double posts = std::exp2(-texelShift);
    return {frame.origin, frame.perColumn * posts, frame.perRow * posts};
}

absl::StatusOr<ColourPlace> placeOf(const ColourFile& file, const TexelGrid& grid,
                                    QuietGdal& gdal) {
    const double columns = GDALGetRasterXSize(file.dataset.get());
    const double rows = GDALGetRasterYSize(file.dataset.get());
    const terrain::GridFrame& frame = grid.frame;
    if (!file.isGeoreferenced) {
        const fabric::Vec2 size(frame.columns, frame.rows);
        return ColourPlace{fabric::Vec2(-0.5), size - 0.5,
                           std::min(size.x / columns, size.y / rows)};
    }
    ASSIGN_OR_RETURN(const Transformer transformer, transformerOf(file, grid, gdal));
    // GDALSuggestedWarpOutput2 takes a picture that needs no reprojection for a square.
    const auto postAt = [&](double column, double row, fabric::Vec2& post) {
        double z = 0;
        int isDone = 0;
        GDALGenImgProjTransform(transformer.get(), FALSE, 1, &column, &row, &z, &isDone);
        post = postOf({column, row}, frame);
        return isDone != 0 && std::isfinite(post.x) && std::isfinite(post.y);
    };
    const auto pixelAt = [&](const fabric::Vec2& post, fabric::Vec2& pixel) {
        pixel = frame.origin + frame.perColumn * post.x + frame.perRow * post.y;
        double z = 0;
        int isDone = 0;
        GDALGenImgProjTransform(transformer.get(), TRUE, 1, &pixel.x, &pixel.y, &z, &isDone);
        return isDone != 0 && isWithin(pixel, fabric::Vec2(0), {columns, rows});
    };
    Sides anywhere;
    Sides onTerrain;  // which may be a small part of a picture that is the finer the farther away
    const fabric::Vec2 last(frame.columns - 1, frame.rows - 1);
    const auto lookAt = [&](double column, double row, const fabric::Vec2& post) {
        fabric::Vec2 right;
        fabric::Vec2 below;
        if (!postAt(column + 1, row, right) || !postAt(column, row + 1, below))
            return;
        const double side = std::min(glm::distance(right, post), glm::distance(below, post));
        anywhere.add(side);
        if (isWithin(post, fabric::Vec2(0), last))
            onTerrain.add(side);
    };
    constexpr int kSteps = 20;
    ColourPlace place;
    place.low = fabric::Vec2(std::numeric_limits<double>::infinity());
    place.high = -place.low;
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i) {
            const double column = columns * i / kSteps;
            const double row = rows * j / kSteps;
            fabric::Vec2 post;
            fabric::Vec2 pixel;
            if (postAt(column, row, post)) {
                place.low = glm::min(place.low, post);
                place.high = glm::max(place.high, post);
                lookAt(column, row, post);
                // Poles are on its rim, and at any column.
                const bool isInside = i > 0 && i < kSteps && j > 0 && j < kSteps;
                if (isInside && isWithin(post, fabric::Vec2(0), last) && !pixelAt(post, pixel))
                    place.isCutOff = true;
            }
            const fabric::Vec2 there = last * fabric::Vec2(i, j) / static_cast<double>(kSteps);
            if (pixelAt(there, pixel))
                lookAt(pixel.x, pixel.y, there);
        }
    if (anywhere.count == 0)
        return cannotBeBrought(file, gdal);
    if (isAroundTheEarth(file.dataset.get())) {
        // Where its rims lie within the terrain there is more of it between the points.
        place.low = glm::min(place.low, fabric::Vec2(-0.5));
        place.high = glm::max(place.high, fabric::Vec2(frame.columns, frame.rows) - 0.5);
    }
    // Sides may bulge between the points that were looked at.
    const fabric::Vec2 margin = (place.high - place.low) / static_cast<double>(kSteps * kSteps);
    place.low -= margin;
    place.high += margin;
    place.pixelPosts = (onTerrain.count > 0 ? onTerrain : anywhere).mean();
    return place;
}

absl::StatusOr<int> rowsAtOnce(const ColourFile& file, const TexelGrid& grid, int texelShift,
                               const terrain::TexelRect& box, QuietGdal& gdal) {
    constexpr std::int64_t kSide = terrain::kTextureSide;
    constexpr double kPiece = kStripPieceRows;
    constexpr double kBeside = terrain::kTextureBorder + kPiece;  // blocks of the warped view
    constexpr int kSteps = 32;
    ASSIGN_OR_RETURN(const Transformer transformer, transformerOf(file, grid, gdal));
    const Georeference texels = grid.reference(texelShift);
    const double height = GDALGetRasterYSize(file.dataset.get());
    double most = 0;
    const std::int64_t tileRows = box.rows / kSide + 1;
    for (std::int64_t row = 0; row < tileRows; row += tileRows / kSteps + 1) {
        const double top = static_cast<double>(box.y + row * kSide);
        double low = height;
        double high = 0;
        for (int k = 0; k <= kSteps; ++k)
            for (const double y : {top - kBeside, top + kSide + kBeside}) {
                const double x = static_cast<double>(box.x) + box.columns * (k / double{kSteps});
                fabric::Vec2 at = texels.origin + texels.perColumn * x + texels.perRow * y;
                double z = 0;
                int isDone = 0;
                GDALGenImgProjTransform(transformer.get(), TRUE, 1, &at.x, &at.y, &z, &isDone);
                if (isDone == 0 || !std::isfinite(at.y))
                    continue;
                low = std::min(low, at.y);
                high = std::max(high, at.y);
            }
        most = std::max(most, std::min(high, height) - std::max(low, 0.0));
    }
    return static_cast<int>(std::ceil(std::min(most + 2 * kPiece, height)));
}

absl::StatusOr<Dataset> warpedTo(const ColourFile& file, const TexelGrid& grid, int texelShift,
                                 const terrain::TexelRect& box, QuietGdal& gdal) {
    if (!file.isGeoreferenced)
        GDALSetGeoTransform(file.dataset.get(),
                            geoTransform(stretched(grid, GDALGetRasterXSize(file.dataset.get()),
                                                   GDALGetRasterYSize(file.dataset.get())))
                                .data());
    ASSIGN_OR_RETURN(Transformer exact, transformerOf(file, grid, gdal));
    Georeference reference = grid.reference(texelShift);
    reference.origin += reference.perColumn * static_cast<double>(box.x) +
                        reference.perRow * static_cast<double>(box.y);
    std::array<double, 6> t = geoTransform(reference);
    GDALSetGenImgProjTransformerDstGeoTransform(exact.get(), t.data());
    Transformer transformer(
        GDALCreateApproxTransformer(GDALGenImgProjTransform, exact.get(), kTransformPixels));
    GDALApproxTransformerOwnsSubtransformer(transformer.get(), TRUE);
    exact.release();

    const WarpOptions options(GDALCreateWarpOptions());
    options->hSrcDS = file.dataset.get();
    options->eResampleAlg = GRA_Bilinear;
    options->eWorkingDataType = GDT_Byte;
    options->dfWarpMemoryLimit = 16 << 20;
    GDALWarpInitDefaultBandMapping(options.get(), kColours);
    options->nSrcAlphaBand = kColours + 1;
    options->nDstAlphaBand = kColours + 1;
    options->papszWarpOptions =
        CSLSetNameValue(options->papszWarpOptions, "NUM_THREADS", gdalThreads().c_str());
    options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "0");
    for (const std::string& option : polarWarpOptions(file.dataset.get()))
        options->papszWarpOptions = CSLAddString(options->papszWarpOptions, option.c_str());
    options->pfnTransformer = GDALApproxTransform;
    options->pTransformerArg = transformer.release();  // of the result from here on
    Dataset result(
        GDALCreateWarpedVRT(file.dataset.get(), box.columns, box.rows, t.data(), options.get()));
    if (!result)
        return cannotBeBrought(file, gdal);
    return result;
}

}  // namespace eyrie::import
