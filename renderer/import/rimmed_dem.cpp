// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/rimmed_dem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <gdal_priv.h>
#include <glm/common.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <ogr_spatialref.h>

#include "renderer/import/float_heights.h"
#include "renderer/terrain/height_grid.h"

namespace eyrie::import {
namespace {

using fabric::Vec2;

constexpr float kNone = terrain::kNodata;

/// From one CRS to another, x before y. Heights stay out of it.
class Way {
public:
    /// Both null: none is needed.
    Way(OGRSpatialReferenceH from, OGRSpatialReferenceH to)
        : isGeographic_(to != nullptr && OSRIsGeographic(to) != 0) {
        if (isSameCrs(from, to))
            return;
        const SpatialReference flatFrom = flat(from);
        const SpatialReference flatTo = flat(to);
        transformation_.reset(
            OGRCreateCoordinateTransformation(OGRSpatialReference::FromHandle(flatFrom.get()),
                                              OGRSpatialReference::FromHandle(flatTo.get())));
        isNone_ = transformation_ == nullptr;
    }

    /// NaN where there is no place. Degrees are called as near to `middle` as may be.
    Vec2 place(Vec2 from, double middle) const {
        const CPLErrorStateBackuper before;  // where there is no place nothing has failed
        const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
        if (isNone_ || (transformation_ && !transformation_->Transform(1, &from.x, &from.y)))
            return Vec2(std::numeric_limits<double>::quiet_NaN());
        if (isGeographic_)
            from.x -= 360 * std::round((from.x - middle) / 360);
        return from;
    }

private:
    static SpatialReference flat(OGRSpatialReferenceH crs) {
        SpatialReference copy(OSRClone(crs));
        OGRSpatialReference::FromHandle(copy.get())->StripVertical();
        OSRSetAxisMappingStrategy(copy.get(), OAMS_TRADITIONAL_GIS_ORDER);
        return copy;
    }

    std::unique_ptr<OGRCoordinateTransformation> transformation_;
    bool isGeographic_;
    bool isNone_ = false;
};

Georeference georeferenceOf(GDALDatasetH raster) {
    std::array<double, 6> t{};
    GDALGetGeoTransform(raster, t.data());
    return {{t[0], t[3]}, {t[1], t[4]}, {t[2], t[5]}};
}

/// A neighbour as it is asked for heights.
class Neighbour {
public:
    Neighbour(const DemNeighbour& neighbour, OGRSpatialReferenceH from)
        : band_(GDALDataset::FromHandle(neighbour.heights)->GetRasterBand(1)),
          box_(neighbour.box),
          way_(from, GDALGetSpatialRef(neighbour.heights)),
          reference_(georeferenceOf(neighbour.heights)),
          toPixel_(glm::inverse(glm::dmat2(reference_.perColumn, reference_.perRow))),
          middle_((reference_.origin + reference_.perColumn * (band_->GetXSize() * 0.5) +
                   reference_.perRow * (band_->GetYSize() * 0.5))
                      .x) {}

    /// `pixel` is of the mosaic's grid.
    bool mayHave(const Vec2& pixel) const {
        const Vec2 off =
            pixel - Vec2(static_cast<double>(box_.column), static_cast<double>(box_.row));
        return off.x >= -1 && off.y >= -1 && off.x <= box_.columns + 1 && off.y <= box_.rows + 1;
    }

    /// Bilinear; NaN where it has not, and nothing where it cannot be read.
    std::optional<float> heightAt(const Vec2& place) const {
        const Vec2 post = toPixel_ * (way_.place(place, middle_) - reference_.origin) - Vec2(0.5);
        const Axis across = axisAt(post.x, band_->GetXSize());
        const Axis along = axisAt(post.y, band_->GetYSize());
        if (across.posts == 0 || along.posts == 0)
            return kNone;
        std::array<float, 4> posts{};
        if (band_->RasterIO(GF_Read, across.first, along.first, across.posts, along.posts,
                            posts.data(), across.posts, along.posts, GDT_Float32, 0, 0,
                            nullptr) != CE_None)
            return std::nullopt;
        const auto line = [&](int row) {
            const float* const from =
                posts.data() + static_cast<std::ptrdiff_t>(row) * across.posts;
            return across.posts == 1 ? double{*from}
                                     : from[0] + (double{from[1]} - from[0]) * across.part;
        };
        const double first = line(0);
        return static_cast<float>(along.posts == 1 ? first
                                                   : first + (line(1) - first) * along.part);
    }

private:
    /// Posts that a place lies between, and how far; one where it lies on it; or none.
    struct Axis {
        int first = 0;
        int posts = 0;
        double part = 0;
    };

    static Axis axisAt(double post, int count) {
        constexpr double kOnPost = 1e-3;
        if (const double nearest = std::round(post); std::abs(post - nearest) < kOnPost)
            return nearest >= 0 && nearest < count ? Axis{static_cast<int>(nearest), 1, 0} : Axis{};
        if (!(post > 0 && post < count - 1))
            return {};
        const double first = std::floor(post);
        return {static_cast<int>(first), 2, post - first};
    }

    GDALRasterBand* band_;
    PixelBox box_;
    Way way_;
    Georeference reference_;
    glm::dmat2 toPixel_;
    double middle_;  ///< its longitude, or whatever x is
};

/// How the pixels of a raster lie, and what lies beside it.
struct Surroundings {
    Georeference reference;  ///< with the rim
    Way toGrid;
    PixelGrid grid;
    std::vector<Neighbour> neighbours;

    /// NaN where none has one, and nothing where it cannot be read.
    std::optional<float> heightOf(int column, int row) const {
        const Vec2 place = reference.origin + reference.perColumn * (column + 0.5) +
                           reference.perRow * (row + 0.5);
        const Vec2 onGrid = toGrid.place(place, grid.x);
        const Vec2 pixel((onGrid.x - grid.x) / grid.width, (grid.y - onGrid.y) / grid.height);
        for (const Neighbour& neighbour : neighbours)
            if (neighbour.mayHave(pixel))
                if (const std::optional<float> height = neighbour.heightAt(place);
                    !height || *height == *height)
                    return height;
        return kNone;
    }
};

class RimmedBand : public FloatHeights {
public:
    /// `own` begins some columns and a row in.
    RimmedBand(GDALDataset* owner, GDALRasterBand* own, int marginColumns, Surroundings around)
        : FloatHeights(owner, own->GetXSize() + 2 * marginColumns, own->GetYSize() + 2),
          own_(own),
          marginColumns_(marginColumns),
          around_(std::move(around)) {}

protected:
    CPLErr IReadBlock(int x, int y, void* data) override {
        const int i = x * nBlockXSize;
        const int j = y * nBlockYSize;
        if (!readOwn(i - 1, j - 1))
            return CE_Failure;
        auto* const block = static_cast<float*>(data);
        const int columns = std::min(nBlockXSize, nRasterXSize - i);
        const int rows = std::min(nBlockYSize, nRasterYSize - j);
        for (int v = 0; v < rows; ++v)
            for (int u = 0; u < columns; ++u) {
                float height = at(u, v);
                if (height != height && isBesideData(u, v)) {
                    const std::optional<float> found = around_.heightOf(i + u, j + v);
                    if (!found)
                        return CE_Failure;
                    height = *found;
                }
                block[static_cast<std::ptrdiff_t>(v) * nBlockXSize + u] = height;
            }
        return CE_None;
    }

private:
    /// Of a block, with a pixel around it.
    int side() const { return nBlockXSize + 2; }

    float at(int u, int v) const {
        return heights_[static_cast<std::size_t>(v + 1) * static_cast<std::size_t>(side()) +
                        static_cast<std::size_t>(u + 1)];
    }

    bool isBesideData(int u, int v) const {
        for (int b = v - 1; b <= v + 1; ++b)
            for (int a = u - 1; a <= u + 1; ++a)
                if (at(a, b) == at(a, b))
                    return true;
        return false;
    }

    /// The raster itself, from a pixel (i, j) on.
    bool readOwn(int i, int j) {
        const auto all = static_cast<std::size_t>(side());
        heights_.assign(all * all, kNone);
        const int i0 = std::max(i, marginColumns_);
        const int j0 = std::max(j, 1);
        const int columns = std::min(i + side(), marginColumns_ + own_->GetXSize()) - i0;
        const int rows = std::min(j + side(), 1 + own_->GetYSize()) - j0;
        if (columns <= 0 || rows <= 0)
            return true;
        float* const to = heights_.data() + static_cast<std::ptrdiff_t>(j0 - j) * side() + (i0 - i);
        return own_->RasterIO(GF_Read, i0 - marginColumns_, j0 - 1, columns, rows, to, columns,
                              rows, GDT_Float32, sizeof(float),
                              static_cast<GSpacing>(sizeof(float)) * side(), nullptr) == CE_None;
    }

    GDALRasterBand* own_;
    int marginColumns_;
    Surroundings around_;
    std::vector<float> heights_;
};

class RimmedDataset : public GDALDataset {
public:
    RimmedDataset(GDALDataset& heights, const std::vector<DemNeighbour>& neighbours,
                  const PixelGrid& grid, OGRSpatialReferenceH crs)
        : crs_(heights.GetSpatialRef()) {
        const OGRSpatialReferenceH own =
            OGRSpatialReference::ToHandle(const_cast<OGRSpatialReference*>(crs_));
        Surroundings around{
            georeferenceOf(GDALDataset::ToHandle(&heights)), Way(own, crs), grid, {}};
        Georeference& reference = around.reference;
        const int margin = marginColumns(own, reference.perColumn.x, heights.GetRasterXSize());
        reference.origin -= reference.perColumn * static_cast<double>(margin) + reference.perRow;
        transform_ = geoTransform(reference);
        for (const DemNeighbour& neighbour : neighbours)
            around.neighbours.emplace_back(neighbour, own);
        nRasterXSize = heights.GetRasterXSize() + 2 * margin;
        nRasterYSize = heights.GetRasterYSize() + 2;
        SetBand(1, new RimmedBand(this, heights.GetRasterBand(1), margin, std::move(around)));
    }
    ~RimmedDataset() override { FlushCache(true); }

    CPLErr GetGeoTransform(double* transform) override {
        std::copy(transform_.begin(), transform_.end(), transform);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override { return crs_; }

private:
    /// None around the earth: GDAL's warper knows each longitude by one name only.
    static int marginColumns(OGRSpatialReferenceH crs, double degrees, int columns) {
        constexpr double kTurn = 360;
        const bool isRound = crs != nullptr && OSRIsGeographic(crs) != 0 &&
                             std::abs(degrees) * (columns + 2) > kTurn;
        return isRound ? 0 : 1;
    }

    const OGRSpatialReference* crs_;
    std::array<double, 6> transform_{};
};

}  // namespace

Dataset rimmed(GDALDatasetH heights, const std::vector<DemNeighbour>& neighbours,
               const PixelGrid& grid, OGRSpatialReferenceH crs) {
    return Dataset(GDALDataset::ToHandle(
        new RimmedDataset(*GDALDataset::FromHandle(heights), neighbours, grid, crs)));
}

}  // namespace eyrie::import
