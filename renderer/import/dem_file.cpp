// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <absl/strings/ascii.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <glm/trigonometric.hpp>

#include "fabric/scene_reach.h"
#include "fabric/status.h"
#include "renderer/import/float_heights.h"
#include "renderer/import/raster_file.h"
#include "renderer/terrain/height_grid.h"

namespace eyrie::import {
namespace {

/// What a pixel value has to go through to be metres.
struct ValueRule {
    bool isSignedByte = false;     ///< GDAL before 3.7 reads these as 0 to 255
    std::optional<double> nodata;  ///< as values of the raster's type have it
    bool lowestIsNodata = false;   ///< -32768, in 16-bit rasters, said or not
    double scale = 1;
    double offset = 0;
    bool isWide = false;     ///< values may have more digits than floats have
    bool isRounded = false;  ///< and so may heights
};

/// Refuses bands that hold something else than heights.
absl::Status checkBand(const std::string& path, GDALRasterBandH band) {
    const GDALDataType type = GDALGetRasterDataType(band);
    if (GDALDataTypeIsComplex(type))
        return invalid(path, fmt::format("band 1 holds complex numbers ({}), not heights",
                                         GDALGetDataTypeName(type)));
    // Of other types a colour table is how programs show the heights.
    const bool mayBePicture = type == GDT_Byte || type == GDT_UInt16;
    const GDALColorInterp colour = GDALGetRasterColorInterpretation(band);
    if (mayBePicture && (colour == GCI_PaletteIndex || GDALGetRasterColorTable(band) != nullptr))
        return invalid(path, "band 1 holds palette indices of a picture, not heights");
    if (colour >= GCI_RedBand && colour <= GCI_YCbCr_CrBand)
        return invalid(path, fmt::format("band 1 is a picture's ({}), not heights; give a DEM",
                                         GDALGetColorInterpretationName(colour)));
    return absl::OkStatus();
}

/// Metres per unit of a band's unit tag, singular or plural; nothing for what it does not know.
std::optional<double> metresPerUnit(const std::string& unit) {
    struct Unit {
        const char* name;
        double metres;
    };
    constexpr double kFoot = 0.3048;
    constexpr double kUsSurveyFoot = 1200.0 / 3937.0;
    constexpr std::array<Unit, 30> kUnits = {{{"", 1},
                                              {"m", 1},
                                              {"metre", 1},
                                              {"meter", 1},
                                              {"ft", kFoot},
                                              {"feet", kFoot},
                                              {"foot", kFoot},
                                              {"International foot", kFoot},
                                              {"International feet", kFoot},
                                              {"foot (International)", kFoot},
                                              {"US survey foot", kUsSurveyFoot},
                                              {"US survey feet", kUsSurveyFoot},
                                              {"US_survey_foot", kUsSurveyFoot},
                                              {"survey foot", kUsSurveyFoot},
                                              {"us-ft", kUsSurveyFoot},
                                              {"ftUS", kUsSurveyFoot},
                                              {"foot_survey_us", kUsSurveyFoot},
                                              {"Foot_US", kUsSurveyFoot},
                                              {"km", 1000},
                                              {"kilometre", 1000},
                                              {"kilometer", 1000},
                                              {"dm", 0.1},
                                              {"decimetre", 0.1},
                                              {"decimeter", 0.1},
                                              {"cm", 0.01},
                                              {"centimetre", 0.01},
                                              {"centimeter", 0.01},
                                              {"mm", 0.001},
                                              {"millimetre", 0.001},
                                              {"millimeter", 0.001}}};
    const auto isCalled = [&unit](const std::string& name) {
        constexpr std::size_t kLongestSymbol = 3;  // of which there is no plural
        return EQUAL(unit.c_str(), name.c_str()) ||
               (name.size() > kLongestSymbol && EQUAL(unit.c_str(), (name + 's').c_str()));
    };
    for (const Unit& known : kUnits)
        if (isCalled(known.name))
            return known.metres;
    return std::nullopt;
}

/// Of the heights of a CRS (null: none); nothing where it says none.
std::optional<double> metresPerUnitOf(OGRSpatialReferenceH crs, std::string& name) {
    if (crs == nullptr || (OSRIsCompound(crs) == 0 && OSRIsVertical(crs) == 0))
        return std::nullopt;
    char* found = nullptr;
    const double metres = OSRGetTargetLinearUnits(crs, "VERT_CS", &found);
    if (!(metres > 0) || !std::isfinite(metres))
        return std::nullopt;
    name = found != nullptr ? found : "";
    return metres;
}

/// Of the band's unit tag or, where it has none that is known, of the heights of its CRS (null:
/// none): some formats keep the one, some the other. Metres where nothing says it.
double metresPerUnit(GDALRasterBandH band, OGRSpatialReferenceH crs,
                     std::vector<std::string>& notes) {
    const std::string unit(absl::StripAsciiWhitespace(GDALGetRasterUnitType(band)));
    if (const auto metres = metresPerUnit(unit); metres && !unit.empty()) {
        if (*metres != 1)
            notes.push_back(fmt::format("heights in {} turned to metres", unit));
        return *metres;
    }
    std::string name;
    if (const auto metres = metresPerUnitOf(crs, name)) {
        if (!unit.empty())
            notes.push_back(
                fmt::format("height unit '{}' is unknown; taken for that of its CRS", unit));
        if (*metres != 1)
            notes.push_back(fmt::format(
                "heights in {} turned to metres, by the vertical unit of its CRS", name));
        return *metres;
    }
    if (!unit.empty())
        notes.push_back(fmt::format("height unit '{}' is unknown; taken for metres", unit));
    else if (crs != nullptr && OSRIsProjected(crs) != 0 && OSRGetLinearUnits(crs, nullptr) != 1)
        notes.emplace_back(
            "its places are not in metres, and nothing says the unit of its heights: taken for "
            "metres; if they are in feet, say so first (gdal_edit.py -units \"US survey foot\")");
    return 1;
}

/// Whether its vertical axis points down. That tells nothing of a file's values: BAGs of NOAA, and
/// what is made of them, have such a CRS and elevations below zero. `crs` may be null.
bool isDepth(OGRSpatialReferenceH crs) {
    if (crs == nullptr || (OSRIsCompound(crs) == 0 && OSRIsVertical(crs) == 0))
        return false;
    OGRAxisOrientation axis = OAO_Other;
    OSRGetAxis(crs, "VERT_CS", 0, &axis);
    return axis == OAO_Down;
}

absl::StatusOr<ValueRule> valueRule(const std::string& path, GDALRasterBandH band,
                                    OGRSpatialReferenceH crs, std::vector<std::string>& notes) {
    ValueRule rule;
    int isSet = 0;
    const GDALDataType type = GDALGetRasterDataType(band);
    rule.isWide = GDALGetDataTypeSizeBits(type) > 16 && type != GDT_Float32;
    const double nodata = GDALGetRasterNoDataValue(band, &isSet);
    if (isSet != 0)
        rule.nodata = rule.isWide ? nodata : static_cast<float>(nodata);
    rule.lowestIsNodata = type == GDT_Int16;
    const char* const pixelType = GDALGetMetadataItem(band, "PIXELTYPE", "IMAGE_STRUCTURE");
    rule.isSignedByte = pixelType != nullptr && EQUAL(pixelType, "SIGNEDBYTE");
    const double scale = GDALGetRasterScale(band, &isSet);
    const double offset = GDALGetRasterOffset(band, &isSet);
    if (!std::isfinite(scale) || !std::isfinite(offset) || scale == 0)
        return invalid(path, fmt::format("band 1 has scale {} and offset {}; both must be finite "
                                         "and the scale not 0",
                                         scale, offset));
    const double unit = metresPerUnit(band, crs, notes);
    if (isDepth(crs))
        notes.emplace_back(
            "its CRS is of depths, but values are taken for heights, upward, as most such files "
            "have them; if they count downward, say so first (gdal_translate -a_scale -1)");
    rule.scale = scale * unit;
    rule.offset = offset * unit;
    const bool isWhole = type != GDT_Float64 && GDALDataTypeIsInteger(type) != 0;
    const bool isAsItIs = rule.scale == 1 && rule.offset == 0;
    rule.isRounded = !(isAsItIs && (isWhole || type == GDT_Float32));
    return rule;
}

bool isSaidToBeNodata(double value, const ValueRule& rule) {
    return value != value || (rule.nodata && value == *rule.nodata);
}

bool isPossible(double value, const ValueRule& rule) {
    constexpr double kImpossible = 1e30;
    return std::abs(value) < kImpossible && !(rule.lowestIsNodata && value == -32768);
}

absl::StatusOr<Georeference> georeferenceOf(const std::string& path, GDALDatasetH dataset,
                                            std::vector<std::string>& notes) {
    std::array<double, 6> t{};
    if (GDALGetGeoTransform(dataset, t.data()) != CE_None) {
        notes.emplace_back("not georeferenced: posts are taken to be 1 m apart");
        const double rows = GDALGetRasterYSize(dataset);
        return Georeference{{0, rows}, {1, 0}, {0, -1}};
    }
    const double determinant = t[1] * t[5] - t[2] * t[4];
    const bool isFinite =
        std::all_of(t.begin(), t.end(), [](double v) { return std::isfinite(v); });
    if (!isFinite || determinant == 0 || !std::isfinite(determinant))
        return invalid(path, fmt::format("geotransform ({}) is not finite or has no area; set "
                                         "another (gdal_edit.py -a_ullr)",
                                         fmt::join(t, ", ")));
    return Georeference{{t[0], t[3]}, {t[1], t[4]}, {t[2], t[5]}};
}

/// Of a raster in another angle than degrees, as grads; others stay as they are.
absl::Status turnToDegrees(const std::string& path, OGRSpatialReferenceH crs,
                           Georeference& reference, std::vector<std::string>& notes) {
    if (crs == nullptr || OSRIsGeographic(crs) == 0)
        return absl::OkStatus();
    char* name = nullptr;
    const double degrees = glm::degrees(OSRGetAngularUnits(crs, &name));
    constexpr double kRounding = 1e-6;  // of the radians that files give a degree
    if (std::abs(degrees - 1) < kRounding)
        return absl::OkStatus();
    notes.push_back(fmt::format("{} turned to degrees", name));
    if (OSRSetAngularUnits(crs, SRS_UA_DEGREE, glm::radians(1.0)) != OGRERR_NONE)
        return invalid(path,
                       "its CRS cannot be brought to degrees; reproject it with gdalwarp "
                       "-t_srs EPSG:4326 first");
    reference = {reference.origin * degrees, reference.perColumn * degrees,
                 reference.perRow * degrees};
    return absl::OkStatus();
}

/// Rows of a raster in degrees whose posts lie beyond a pole: no map has a place for them.
int rowsBeyondPoles(const DemFile& file) {
    const Georeference& g = file.reference;
    if (!file.isGeographic() || g.perColumn.y != 0)
        return 0;
    constexpr double kPole = 90 + 1e-6;  // posts on it may be off by a rounding
    const auto [low, high] =
        std::minmax({(kPole - g.origin.y) / g.perRow.y, (-kPole - g.origin.y) / g.perRow.y});
    const double rows = file.rows;
    const double first = std::clamp(std::ceil(low - 0.5), 0.0, rows);
    const double end = std::clamp(std::floor(high - 0.5) + 1, first, rows);
    return file.rows - static_cast<int>(end - first);
}

/// What says which of a band's pixels have heights, beside its values; null: nothing does.
GDALRasterBand* maskOf(GDALDataset& dataset, GDALRasterBand& heights) {
    const int flags = heights.GetMaskFlags();
    if (flags != GMF_ALL_VALID && flags != GMF_NODATA)
        return heights.GetMaskBand();
    // gdalwarp -dstalpha makes bands of the heights' type, which GDAL itself takes for no mask.
    for (int band = 2; band <= dataset.GetRasterCount(); ++band)
        if (dataset.GetRasterBand(band)->GetColorInterpretation() == GCI_AlphaBand)
            return dataset.GetRasterBand(band);
    return nullptr;
}

/// The heights of another dataset's first band, turned to metres as they are asked for: GDAL's
/// cache has the other's blocks, and no second copy of them.
class HeightBand : public FloatHeights {
public:
    using Impossible = std::shared_ptr<std::optional<ImpossibleHeight>>;

    /// `mask` is 0 where there is no height; null: there is none.
    HeightBand(GDALDataset* owner, int columns, GDALRasterBand* source, GDALRasterBand* mask,
               const ValueRule& rule, Impossible impossible)
        : FloatHeights(owner, columns, source->GetYSize()),
          source_(source),
          mask_(mask),
          rule_(rule),
          impossible_(std::move(impossible)) {
        source->GetBlockSize(&nBlockXSize, &nBlockYSize);
        constexpr std::int64_t kMostValues = 1 << 22;
        if (nBlockXSize < 1 || nBlockYSize < 1 ||
            std::int64_t{nBlockXSize} * nBlockYSize > kMostValues)
            nBlockXSize = nBlockYSize = 512;
    }

protected:
    CPLErr IReadBlock(int x, int y, void* data) override {
        const int i = x * nBlockXSize;
        const int j = y * nBlockYSize;
        return read(i, j, std::min(nBlockXSize, nRasterXSize - i),
                    std::min(nBlockYSize, nRasterYSize - j), static_cast<float*>(data),
                    nBlockXSize);
    }

    CPLErr IRasterIO(GDALRWFlag flag, int i, int j, int columns, int rows, void* data,
                     int dataColumns, int dataRows, GDALDataType type, GSpacing pixel,
                     GSpacing line, GDALRasterIOExtraArg* extra) override {
        constexpr GSpacing kFloat = sizeof(float);
        if (flag != GF_Read || columns != dataColumns || rows != dataRows || type != GDT_Float32 ||
            pixel != kFloat || line % kFloat != 0)
            return GDALRasterBand::IRasterIO(flag, i, j, columns, rows, data, dataColumns, dataRows,
                                             type, pixel, line, extra);
        return read(i, j, columns, rows, static_cast<float*>(data), line / kFloat);
    }

private:
    /// Down each column of the source's blocks, so that each is decoded once; rows are `stride`
    /// heights apart.
    CPLErr read(int i, int j, int columns, int rows, float* heights, std::ptrdiff_t stride) {
        for (int u = 0; u < columns;) {
            const int across = std::min(nBlockXSize - (i + u) % nBlockXSize, columns - u);
            if (readDown(i + u, j, across, rows, heights + u, stride) != CE_None)
                return CE_Failure;
            u += across;
        }
        return CE_None;
    }

    /// Some rows at a time.
    CPLErr readDown(int i, int j, int columns, int rows, float* heights, std::ptrdiff_t stride) {
        constexpr int kRows = 64;
        for (int v = 0; v < rows; v += kRows) {
            const int some = std::min(kRows, rows - v);
            float* const to = heights + v * stride;
            if (mask_ != nullptr && !readMask(i, j + v, columns, some))
                return CE_Failure;
            if (rule_.isWide)
                values_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(some));
            const CPLErr error =
                rule_.isWide ? turn(values_.data(), columns, i, j + v, columns, some, to, stride)
                             : turn(to, stride, i, j + v, columns, some, to, stride);
            if (error != CE_None)
                return error;
        }
        return CE_None;
    }

    /// By way of `values`, each row `line` of them behind the one before, which may be the heights'
    /// own place.
    template <typename T>
    CPLErr turn(T* values, std::ptrdiff_t line, int i, int j, int columns, int rows, float* heights,
                std::ptrdiff_t stride) {
        const GDALDataType type = sizeof(T) == sizeof(double) ? GDT_Float64 : GDT_Float32;
        constexpr GSpacing kBytes = sizeof(T);
        if (source_->RasterIO(GF_Read, i, j, columns, rows, values, columns, rows, type, kBytes,
                              line * kBytes, nullptr) != CE_None)
            return CE_Failure;
        for (int v = 0; v < rows; ++v)
            for (int u = 0; u < columns; ++u)
                heights[v * stride + u] =
                    mask_ != nullptr && valid_[static_cast<std::size_t>(v * columns + u)] == 0
                        ? terrain::kNodata
                        : heightOf(values[v * line + u], i + u, j + v);
        return CE_None;
    }

    bool readMask(int i, int j, int columns, int rows) {
        valid_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        return mask_->RasterIO(GF_Read, i, j, columns, rows, valid_.data(), columns, rows, GDT_Byte,
                               0, 0, nullptr) == CE_None;
    }

    float heightOf(double value, int column, int row) {
        if (rule_.isSignedByte && value > 127)
            value -= 256;
        if (isSaidToBeNodata(value, rule_))
            return terrain::kNodata;
        const bool isHeight = isPossible(value, rule_);
        const double height = value * rule_.scale + rule_.offset;
        if (const auto nearest = static_cast<float>(height);
            isHeight && std::abs(nearest) <= fabric::kMaxSceneMetres)
            return nearest;
        if (!*impossible_)
            *impossible_ = {column, row, isHeight ? height : value};
        return terrain::kNodata;
    }

    GDALRasterBand* source_;
    GDALRasterBand* mask_;
    ValueRule rule_;
    Impossible impossible_;
    std::vector<unsigned char> valid_;
    std::vector<double> values_;
};

class HeightDataset : public GDALDataset {
public:
    /// Its first `columns`, which lie in `crs` (null: none) as `reference` says.
    HeightDataset(Dataset source, OGRSpatialReferenceH crs, const Georeference& reference,
                  int columns, const ValueRule& rule, HeightBand::Impossible impossible)
        : source_(std::move(source)),
          crs_(crs == nullptr ? nullptr : OSRClone(crs)),
          transform_(geoTransform(reference)) {
        GDALDataset* const dataset = GDALDataset::FromHandle(source_.get());
        nRasterXSize = columns;
        nRasterYSize = dataset->GetRasterYSize();
        GDALRasterBand* const heights = dataset->GetRasterBand(1);
        SetBand(1, new HeightBand(this, columns, heights, maskOf(*dataset, *heights), rule,
                                  std::move(impossible)));
    }
    ~HeightDataset() override { FlushCache(true); }

    CPLErr GetGeoTransform(double* transform) override {
        std::copy(transform_.begin(), transform_.end(), transform);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override {
        return OGRSpatialReference::FromHandle(crs_.get());
    }

private:
    Dataset source_;
    SpatialReference crs_;
    std::array<double, 6> transform_;
};

}  // namespace

bool DemFile::isGeographic() const { return crs && OSRIsGeographic(crs.get()) != 0; }

fabric::Vec2 centreOf(const DemFile& file) {
    return file.reference.origin + file.reference.perColumn * (file.columns * 0.5) +
           file.reference.perRow * (file.rows * 0.5);
}

absl::StatusOr<DemFile> openDemFile(const std::string& path, QuietGdal& gdal,
                                    const std::string& hashFolder, const std::stop_token& stop) {
    DemFile file;
    file.path = path;
    ASSIGN_OR_RETURN(
        Dataset dataset,
        openRaster(path,
                   "a DEM such as a GeoTIFF, or a mesh whose name ends in .ply, .obj, .glb or "
                   "as README.md lists",
                   gdal));
    const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
    RETURN_IF_ERROR(checkBand(path, band));
    file.columns = GDALGetRasterXSize(dataset.get());
    file.rows = GDALGetRasterYSize(dataset.get());
    if (GDALGetRasterCount(dataset.get()) > 1)
        file.notes.push_back(
            fmt::format("band 1 of {} taken for heights", GDALGetRasterCount(dataset.get())));
    RETURN_IF_ERROR(checkPlace(path, dataset.get()));
    const OGRSpatialReferenceH crs = crsOf(dataset.get());
    if (crs != nullptr && OSRIsDerivedGeographic(crs) != 0)
        return invalid(path,
                       "is in degrees of a rotated pole, not of the earth; reproject it with "
                       "gdalwarp -t_srs EPSG:4326 first");
    if (crs != nullptr && OSRIsGeocentric(crs) != 0)
        return invalid(path, fmt::format("its CRS ({}) counts from the earth's centre, so its "
                                         "pixels are no map; give it the right one (gdal_edit.py "
                                         "-a_srs)",
                                         OSRGetName(crs)));
    ASSIGN_OR_RETURN(const ValueRule rule, valueRule(path, band, crs, file.notes));
    GDALGetBlockSize(band, &file.blockColumns, &file.blockRows);
    file.valueBytes = GDALGetDataTypeSizeBytes(GDALGetRasterDataType(band));
    if (GDALRasterBand* const mask =
            maskOf(*GDALDataset::FromHandle(dataset.get()), *GDALRasterBand::FromHandle(band)))
        file.valueBytes += GDALGetDataTypeSizeBytes(mask->GetRasterDataType());
    file.isRounded = rule.isRounded;
    std::array<double, 6> ignored{};
    file.isGeoreferenced = GDALGetGeoTransform(dataset.get(), ignored.data()) == CE_None;
    ASSIGN_OR_RETURN(file.reference, georeferenceOf(path, dataset.get(), file.notes));
    if (crs != nullptr)
        file.crs.reset(OSRClone(crs));
    RETURN_IF_ERROR(turnToDegrees(path, file.crs.get(), file.reference, file.notes));
    if (const int rows = rowsBeyondPoles(file); rows > 0)
        file.notes.push_back(
            fmt::format("{} of {} rows lie beyond a pole; they are left out", rows, file.rows));
    cutToOneTurn(file.crs.get(), file.reference, file.columns);
    ASSIGN_OR_RETURN(file.hash, rasterHash(path, dataset.get(), hashFolder, stop));
    const auto impossible = std::make_shared<std::optional<ImpossibleHeight>>();
    file.impossible = impossible;
    file.dataset.reset(GDALDataset::ToHandle(new HeightDataset(
        std::move(dataset), file.crs.get(), file.reference, file.columns, rule, impossible)));
    return file;
}

}  // namespace eyrie::import
