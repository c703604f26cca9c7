// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/joined_dems.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gdal_priv.h>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "renderer/import/float_heights.h"
#include "renderer/terrain/height_grid.h"

namespace eyrie::import {
namespace {

using fabric::Vec2;

/// One file's place in the joined raster.
struct Member {
    GDALRasterBand* band;
    int column;
    int row;
};

class JoinedBand : public FloatHeights {
public:
    JoinedBand(GDALDataset* owner, int columns, int rows, std::vector<Member> members)
        : FloatHeights(owner, columns, rows), members_(std::move(members)) {}

protected:
    CPLErr IReadBlock(int x, int y, void* data) override {
        auto* const block = static_cast<float*>(data);
        std::fill_n(block, static_cast<std::ptrdiff_t>(nBlockXSize) * nBlockYSize,
                    terrain::kNodata);
        for (const Member& member : members_)
            if (!fill(member, x * nBlockXSize, y * nBlockYSize, block))
                return CE_Failure;
        return CE_None;
    }

private:
    /// Of the block whose first pixel is (i, j), what has no data so far.
    bool fill(const Member& member, int i, int j, float* block) {
        const int i0 = std::max(i, member.column);
        const int j0 = std::max(j, member.row);
        const int columns = std::min(i + nBlockXSize, member.column + member.band->GetXSize()) - i0;
        const int rows = std::min(j + nBlockYSize, member.row + member.band->GetYSize()) - j0;
        if (columns <= 0 || rows <= 0)
            return true;
        heights_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        if (member.band->RasterIO(GF_Read, i0 - member.column, j0 - member.row, columns, rows,
                                  heights_.data(), columns, rows, GDT_Float32, 0, 0,
                                  nullptr) != CE_None)
            return false;
        const float* from = heights_.data();
        for (int v = 0; v < rows; ++v) {
            float* to = block + static_cast<std::ptrdiff_t>(j0 - j + v) * nBlockXSize + (i0 - i);
            for (int u = 0; u < columns; ++u, ++to, ++from)
                if (*to != *to)
                    *to = *from;
        }
        return true;
    }

    std::vector<Member> members_;
    std::vector<float> heights_;
};

class JoinedDataset : public GDALDataset {
public:
    JoinedDataset(const DemFile& first, const Georeference& reference, int columns, int rows,
                  std::vector<Member> members)
        : transform_(geoTransform(reference)),
          crs_(OGRSpatialReference::FromHandle(first.crs.get())) {
        nRasterXSize = columns;
        nRasterYSize = rows;
        SetBand(1, new JoinedBand(this, columns, rows, std::move(members)));
    }
    ~JoinedDataset() override { FlushCache(true); }

    CPLErr GetGeoTransform(double* transform) override {
        std::copy(transform_.begin(), transform_.end(), transform);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override { return crs_; }

private:
    std::array<double, 6> transform_;
    const OGRSpatialReference* crs_;
};

/// From the outer corner of the first pixel of `grid`, in pixels.
Vec2 inPixels(const Georeference& grid, const Vec2& point) {
    return glm::inverse(glm::dmat2(grid.perColumn, grid.perRow)) * (point - grid.origin);
}

/// The corner of a file that its first pixel has, from the same longitude's name that `first` uses.
Vec2 originBeside(const DemFile& first, const DemFile& file) {
    Vec2 origin = file.reference.origin;
    // Of two halves of the earth neither is moved.
    constexpr double kMoved = 0.5 + 1e-6;  // turns
    if (const double turns = (centreOf(file).x - centreOf(first).x) / 360;
        first.isGeographic() && std::abs(turns) > kMoved)
        origin.x -= 360 * std::round(turns);
    return origin;
}

}  // namespace

bool isOneGrid(const DemFile& first, const DemFile& file) {
    constexpr int kFarthest = 1 << 29;  // so that GDAL can count all of them
    if (std::max({first.columns, first.rows, file.columns, file.rows}) >= kFarthest)
        return false;
    const Vec2 origin = originBeside(first, file);
    const Vec2 place = glm::round(inPixels(first.reference, origin));
    const auto isThere = [&](const Vec2& corner, const Vec2& pixel) {
        constexpr double kPixels = 1e-3;
        const Vec2 off = glm::abs(inPixels(first.reference, corner) - place - pixel);
        return off.x < kPixels && off.y < kPixels;
    };
    const Georeference& own = file.reference;
    const double columns = file.columns;
    const double rows = file.rows;
    return std::abs(place.x) < kFarthest && std::abs(place.y) < kFarthest &&
           isThere(origin, {0, 0}) && isThere(origin + own.perColumn * columns, {columns, 0}) &&
           isThere(origin + own.perRow * rows, {0, rows}) &&
           isSameCrs(first.crs.get(), file.crs.get());
}

Dataset joined(std::span<const DemFile> files) {
    const DemFile& first = files.front();
    std::vector<Member> members;
    int left = 0;
    int top = 0;
    int right = first.columns;
    int bottom = first.rows;
    for (const DemFile& file : files) {
        const Vec2 place = glm::round(inPixels(first.reference, originBeside(first, file)));
        const Member& member = members.emplace_back(
            Member{GDALDataset::FromHandle(file.dataset.get())->GetRasterBand(1),
                   static_cast<int>(place.x), static_cast<int>(place.y)});
        left = std::min(left, member.column);
        top = std::min(top, member.row);
        right = std::max(right, member.column + file.columns);
        bottom = std::max(bottom, member.row + file.rows);
    }
    for (Member& member : members) {
        member.column -= left;
        member.row -= top;
    }
    Georeference reference = first.reference;
    reference.origin += reference.perColumn * static_cast<double>(left) +
                        reference.perRow * static_cast<double>(top);
    int columns = right - left;
    cutToOneTurn(first.crs.get(), reference, columns);  // which tiles may pass that each do not
    return Dataset(GDALDataset::ToHandle(
        new JoinedDataset(first, reference, columns, bottom - top, std::move(members))));
}

}  // namespace eyrie::import
