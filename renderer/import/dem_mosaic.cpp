// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "fabric/status.h"
#include "renderer/import/degrees_caveat.h"
#include "renderer/import/dem_order.h"
#include "renderer/import/dem_warp.h"
#include "renderer/import/joined_dems.h"
#include "renderer/import/layered_dems.h"
#include "renderer/import/length_caveat.h"
#include "renderer/import/local_projection.h"
#include "renderer/import/rimmed_dem.h"

namespace eyrie::import {
namespace {

using fabric::Vec2;

/// Share of a grid's posts: where rasters have fewer, people should know.
constexpr double kMostlyEmpty = 0.1;

double postsOf(const PixelBox& box) { return static_cast<double>(box.columns) * box.rows; }

/// Enlarges `all` (none: of nothing) by `box`.
void addTo(std::optional<PixelBox>& all, const PixelBox& box) {
    const PixelBox before = all.value_or(box);
    const std::int64_t endColumn =
        std::max(before.column + before.columns, box.column + box.columns);
    const std::int64_t endRow = std::max(before.row + before.rows, box.row + box.rows);
    all = PixelBox{std::min(before.column, box.column), std::min(before.row, box.row), 0, 0};
    all->columns = static_cast<int>(endColumn - all->column);
    all->rows = static_cast<int>(endRow - all->row);
}

/// Chooses what several rasters, or one in degrees, are brought to, and brings them there.
class Mosaic {
public:
    Mosaic(std::vector<DemFile> files, QuietGdal& gdal)
        : files_(std::move(files)), name_(nameOf(files_)), gdal_(gdal) {}

    absl::StatusOr<DemSource> open() {
        RETURN_IF_ERROR(check());
        order_ = bestFirst(files_);
        RETURN_IF_ERROR(chooseCrs());
        RETURN_IF_ERROR(chooseGrid());
        const auto isAlone = [this](const DemFile& file) { return isOnGrid(file); };
        for (const std::vector<std::size_t>& run : runsOf(files_, order_, isAlone)) {
            std::vector<DemFile> together;
            for (const std::size_t k : run) together.push_back(std::move(files_[k]));
            RETURN_IF_ERROR(addLayer(std::move(together)));
        }
        RETURN_IF_ERROR(resample());
        return assembled();
    }

private:
    absl::Status check() {
        for (const DemFile& file : files_) {
            if (!file.isGeoreferenced)
                return invalid(file.path,
                               fmt::format("is not georeferenced, so it cannot be {}; give it a "
                                           "georeference (gdal_edit.py)",
                                           files_.size() > 1 ? "laid beside others"
                                                             : "brought from degrees to metres"));
            if ((file.crs == nullptr) != (files_.front().crs == nullptr))
                return invalid(file.path,
                               fmt::format("{} a CRS, unlike {}; set the right one (gdal_edit.py "
                                           "-a_srs)",
                                           file.crs ? "has" : "has not", files_.front().path));
        }
        noteVerticalDatums();
        return absl::OkStatus();
    }

    void noteVerticalDatums() {
        std::map<std::string, std::string> files;  // one of each datum
        for (const DemFile& file : files_) {
            if (!file.crs)
                continue;
            if (const char* const datum = OSRGetAttrValue(file.crs.get(), "VERT_DATUM", 0))
                files.emplace(datum, file.path);
            else if (OSRGetAxesCount(file.crs.get()) == 3)
                files.emplace("the ellipsoid", file.path);
        }
        if (files.size() < 2)
            return;
        std::vector<std::string> found;
        for (const auto& [datum, path] : files)
            found.push_back(fmt::format("'{}' ({})", datum, path));
        notes_.push_back(
            fmt::format("heights above {} are taken as they are; bring them to one "
                        "vertical datum (gdalwarp) if their difference matters",
                        fmt::join(found, " and ")));
    }

    absl::Status chooseCrs() {
        const auto projected = std::find_if(
            order_.begin(), order_.end(), [&](std::size_t k) { return !files_[k].isGeographic(); });
        if (projected != order_.end()) {
            if (const OGRSpatialReferenceH crs = files_[*projected].crs.get())
                crs_.reset(OSRClone(crs));
            return absl::OkStatus();
        }
        GeographicBox box{Vec2(std::numeric_limits<double>::infinity()),
                          Vec2(-std::numeric_limits<double>::infinity())};
        for (const DemFile& file : files_) {
            const Vec2 reach =
                (glm::abs(file.reference.perColumn * static_cast<double>(file.columns)) +
                 glm::abs(file.reference.perRow * static_cast<double>(file.rows))) *
                0.5;
            // The same longitude may be called 180 here and -180 there: the way round is short.
            Vec2 middle = centreOf(file);
            middle.x -= 360 * std::round((middle.x - centreOf(files_.front()).x) / 360);
            box.low = glm::min(box.low, middle - reach);
            box.high = glm::max(box.high, middle + reach);
        }
        ASSIGN_OR_RETURN(LocalProjection local,
                         localProjection(name_, files_.front().crs.get(), box));
        crs_ = std::move(local.crs);
        aroundTheEarth_ = local.aroundTheEarth;
        caveat_ = std::move(local.caveat);
        return absl::OkStatus();
    }

    /// The finest raster's grid, resampled if need be.
    absl::Status chooseGrid() {
        const DemFile& finest = files_[order_.front()];
        wkt_ = crs_ ? wktOf(crs_.get()) : "";
        if (isNorthUp(finest)) {
            grid_ = gridOf(finest.reference);
            return absl::OkStatus();
        }
        ASSIGN_OR_RETURN(const Suggested suggested, suggestedFor(finest));
        grid_ = gridOf(suggested.reference);
        return absl::OkStatus();
    }

    bool isNorthUp(const DemFile& file) const {
        const Georeference& g = file.reference;
        return isSameCrs(file.crs.get(), crs_.get()) && g.perColumn.y == 0 && g.perRow.x == 0 &&
               g.perColumn.x > 0 && g.perRow.y < 0;
    }

    /// Where a raster comes to lie in the CRS, with posts as GDAL suggests them.
    struct Suggested {
        Georeference reference;
        int columns;
        int rows;
    };

    absl::StatusOr<Suggested> suggestedFor(const DemFile& file) {
        const bool isAround = isAroundTheEarth(file.dataset.get());
        std::optional<double> meridian;
        if (isAround && aroundTheEarth_ > 0)
            meridian = OSRGetNormProjParm(crs_.get(), SRS_PP_CENTRAL_MERIDIAN, 0, nullptr);
        const Dataset outline = outlineOf(file.dataset.get(), meridian);
        ASSIGN_OR_RETURN(const Dataset dataset, reprojected(outline.get(), file.path, wkt_, gdal_));
        std::array<double, 6> t{};
        GDALGetGeoTransform(dataset.get(), t.data());
        Suggested suggested{{{t[0], t[3]}, {t[1], t[4]}, {t[2], t[5]}},
                            GDALGetRasterXSize(dataset.get()),
                            GDALGetRasterYSize(dataset.get())};
        if (!isAround)
            return suggested;
        if (meridian) {
            suggested.reference.origin.x = -aroundTheEarth_ / 2;
            suggested.columns =
                static_cast<int>(std::lround(aroundTheEarth_ / suggested.reference.perColumn.x));
            suggested.reference.perColumn.x = aroundTheEarth_ / suggested.columns;
        } else if (const double coarser = postsAtRim(file) / suggested.reference.perColumn.x;
                   coarser > 1) {
            // And for posts as many on the map's diagonal as on the raster's, which is unrolled.
            suggested.reference.perColumn *= coarser;
            suggested.reference.perRow *= coarser;
            suggested.columns = std::max(2, static_cast<int>(suggested.columns / coarser));
            suggested.rows = std::max(2, static_cast<int>(suggested.rows / coarser));
        }
        return suggested;
    }

    /// The smaller of a geographic raster's spacings where they are widest, in units of the CRS.
    double postsAtRim(const DemFile& file) const {
        const Georeference& g = file.reference;
        const double last = g.origin.y + g.perRow.y * file.rows;
        const double rim = glm::radians(std::min(std::abs(g.origin.y), std::abs(last)));
        const double degree = glm::radians(OSRGetSemiMajor(crs_.get(), nullptr)) /
                              OSRGetLinearUnits(crs_.get(), nullptr);
        return degree * std::min(std::abs(g.perColumn.x) * std::cos(rim), std::abs(g.perRow.y));
    }

    static PixelGrid gridOf(const Georeference& g) {
        return {g.origin.x, g.origin.y, g.perColumn.x, -g.perRow.y};
    }

    /// Pixels of the grid whose centres lie in a north-up raster.
    absl::StatusOr<std::optional<PixelBox>> boxOf(const DemFile& file, const Georeference& g,
                                                  int columns, int rows) const {
        const double x0 = (g.origin.x - grid_.x) / grid_.width;
        const double y0 = (grid_.y - g.origin.y) / grid_.height;
        const double x1 = x0 + g.perColumn.x * columns / grid_.width;
        const double y1 = y0 - g.perRow.y * rows / grid_.height;
        constexpr double kFarthest = 1 << 29;  // from rim to rim an int
        if (!(std::abs(x0) < kFarthest && std::abs(y0) < kFarthest && std::abs(x1) < kFarthest &&
              std::abs(y1) < kFarthest))
            return invalid(file.path, "lies too far from the other rasters for one grid");
        constexpr double kSlack = 1e-6;
        const auto first = [](double v) {
            return static_cast<std::int64_t>(std::ceil(v - 0.5 - kSlack));
        };
        const auto end = [](double v) {
            return static_cast<std::int64_t>(std::floor(v - 0.5 + kSlack)) + 1;
        };
        if (end(x1) <= first(x0) || end(y1) <= first(y0))
            return std::nullopt;
        return PixelBox{first(x0), first(y0), static_cast<int>(end(x1) - first(x0)),
                        static_cast<int>(end(y1) - first(y0))};
    }

    /// Whether a raster's pixels are pixels of the grid.
    bool isOnGrid(const DemFile& file) const {
        if (!isNorthUp(file))
            return false;
        constexpr double kPixels = 1e-3;
        const Georeference& g = file.reference;
        const double x = (g.origin.x - grid_.x) / grid_.width;
        const double y = (grid_.y - g.origin.y) / grid_.height;
        return std::abs(g.perColumn.x / grid_.width - 1) * file.columns < kPixels &&
               std::abs(-g.perRow.y / grid_.height - 1) * file.rows < kPixels &&
               std::abs(x - std::round(x)) < kPixels && std::abs(y - std::round(y)) < kPixels;
    }

    /// Pixels of the grid that a raster covers, or nearly: its warper says which, to a pixel. Where
    /// others may go on what it covers beyond a rounded extent is needed, too.
    absl::StatusOr<std::optional<PixelBox>> placeOf(const DemFile& file) {
        if (isNorthUp(file)) {
            ASSIGN_OR_RETURN(const std::optional<PixelBox> box,
                             boxOf(file, file.reference, file.columns, file.rows));
            if (box)
                addTo(extent_, *box);
            return box;
        }
        ASSIGN_OR_RETURN(const Suggested suggested, suggestedFor(file));
        ASSIGN_OR_RETURN(std::optional<PixelBox> box,
                         boxOf(file, suggested.reference, suggested.columns, suggested.rows));
        if (box)
            addTo(extent_, *box);
        if (box && order_.size() > 1)
            box = PixelBox{box->column - 1, box->row - 1, box->columns + 2, box->rows + 2};
        return box;
    }

    absl::Status addLayer(std::vector<DemFile> files) {
        DemLayer layer;
        std::optional<PixelBox> all;
        for (DemFile& file : files) {
            notes_.insert(notes_.end(), file.notes.begin(), file.notes.end());
            ASSIGN_OR_RETURN(const std::optional<PixelBox> box, placeOf(file));
            if (!box) {
                notes_.push_back(fmt::format(
                    "{} has no pixel as large as the finest raster's; it is left out", file.path));
                continue;
            }
            addTo(all, *box);
            placed_ += postsOf(*box);
            layer.files.push_back(std::move(file));
        }
        if (!all)
            return absl::OkStatus();
        layer.box = *all;
        layers_.push_back(std::move(layer));
        return absl::OkStatus();
    }

    /// Two pixels of a layer, in posts, and one for what boxes may be off.
    static int rimReachOf(const DemLayer& layer) {
        const double pixels =
            std::max(static_cast<double>(layer.box.columns) / GDALGetRasterXSize(layer.source()),
                     static_cast<double>(layer.box.rows) / GDALGetRasterYSize(layer.source()));
        return static_cast<int>(std::ceil(2 * pixels)) + 1;
    }

    /// Other layers that lie beside it, best first.
    std::vector<const DemLayer*> besides(const DemLayer& layer) const {
        std::vector<const DemLayer*> found;
        for (const DemLayer& other : layers_) {
            const std::int64_t reach = std::max(layer.rimReach, other.rimReach);
            const auto touch = [reach](std::int64_t a, int columns, std::int64_t b, int others) {
                return a <= b + others + reach && b <= a + columns + reach;
            };
            if (&other != &layer &&
                touch(layer.box.column, layer.box.columns, other.box.column, other.box.columns) &&
                touch(layer.box.row, layer.box.rows, other.box.row, other.box.rows))
                found.push_back(&other);
        }
        return found;
    }

    Dataset rimmedBy(const DemLayer& layer, const std::vector<DemNeighbour>& neighbours) const {
        return neighbours.empty() ? nullptr : rimmed(layer.source(), neighbours, grid_, crs_.get());
    }

    absl::StatusOr<Dataset> onGrid(const DemLayer& layer, GDALDatasetH heights) {
        return reprojected(heights, nameOf(layer.files), wkt_, grid_, layer.box, gdal_);
    }

    /// Two rasters that end at each other are each beside what only the other knows. Rims of what
    /// all know by themselves come first; what ends within another's such rim is told by that.
    absl::Status resample() {
        for (DemLayer& layer : layers_) {
            if (layer.files.size() > 1)
                layer.joined = joined(layer.files);
            layer.rimReach = rimReachOf(layer);
        }
        for (DemLayer& layer : layers_) {
            std::vector<DemNeighbour> neighbours;
            for (const DemLayer* const other : besides(layer))
                neighbours.push_back({other->source(), other->box});
            layer.rimmed = rimmedBy(layer, neighbours);
        }
        for (DemLayer& layer : layers_) {
            if (isOnGrid(layer.files.front()))
                continue;
            std::vector<DemNeighbour> neighbours;
            for (const DemLayer* const other : besides(layer))
                neighbours.push_back({other->source(), other->box});
            for (const DemLayer* const other : besides(layer))
                neighbours.push_back({other->rimmed.get(), other->box});
            layer.twiceRimmed = rimmedBy(layer, neighbours);
            ASSIGN_OR_RETURN(layer.warped, onGrid(layer, layer.source()));
            if (layer.twiceRimmed) {
                ASSIGN_OR_RETURN(layer.rimmedWarped, onGrid(layer, layer.twiceRimmed.get()));
            }
            for (const DemFile& file : layer.files)
                notes_.push_back(fmt::format("{} resampled", file.path));
        }
        return absl::OkStatus();
    }

    absl::StatusOr<DemSource> assembled() {
        const PixelBox all = extent_.value();
        const std::string grid = crs_ ? OSRGetName(crs_.get()) : "one grid";
        RETURN_IF_ERROR(checkSize(name_, all.columns, all.rows, " in " + grid));
        for (DemLayer& layer : layers_) {
            layer.box.column -= all.column;
            layer.box.row -= all.row;
        }
        const Georeference inUnits{Vec2(grid_.x + grid_.width * static_cast<double>(all.column),
                                        grid_.y - grid_.height * static_cast<double>(all.row)),
                                   Vec2(grid_.width, 0), Vec2(0, -grid_.height)};
        const double metres = crs_ ? OSRGetLinearUnits(crs_.get(), nullptr) : 1;
        const Georeference reference{inUnits.origin * metres, inUnits.perColumn * metres,
                                     inUnits.perRow * metres};
        notes_.push_back(fmt::format("brought to {}: {} x {} posts, {:.4g} m apart", grid,
                                     all.columns, all.rows, reference.perColumn.x));
        if (const double share = placed_ / postsOf(all); share < kMostlyEmpty)
            notes_.push_back(
                fmt::format("at most {:.2g} % of these posts are of a raster; what lies far apart "
                            "is better imported as terrains of their own, for one scene",
                            100 * share));
        if (caveat_.empty())
            caveat_ = lengthCaveat(crs_.get(), inUnits, all.columns, all.rows);
        if (!caveat_.empty())
            notes_.push_back(caveat_);
        DemSource source;
        source.posts = layeredDems(std::move(layers_), reference, all.columns, all.rows);
        source.crsWkt = crs_ ? metricWktOf(crs_.get()) : "";
        source.notes = std::move(notes_);
        source.mayBeDegrees = !saysItsUnit(crs_.get()) && mayBeDegrees(source.posts->frame());
        return source;
    }

    std::vector<DemFile> files_;
    std::string name_;  ///< for messages about all of them
    QuietGdal& gdal_;
    std::vector<std::size_t> order_;  ///< best first
    SpatialReference crs_;
    double aroundTheEarth_ = 0;  ///< LocalProjection::aroundTheEarth
    std::string caveat_;         ///< of lengths in the CRS, for people
    std::string wkt_;            ///< of `crs_`, in whose units `grid_` is
    PixelGrid grid_;
    std::vector<DemLayer> layers_;    ///< best first, on the grid
    std::optional<PixelBox> extent_;  ///< of all that have been placed
    double placed_ = 0;               ///< posts of these, those that several have counted anew
    std::vector<std::string> notes_;
};

}  // namespace

absl::StatusOr<DemSource> mosaicOf(std::vector<DemFile> files, QuietGdal& gdal) {
    return Mosaic(std::move(files), gdal).open();
}

}  // namespace eyrie::import
