// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>
#include <gdal_utils.h>
#include <ogr_srs_api.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/terrain/quadtree.h"

namespace eyrie::import {
namespace {

using fabric::Vec2;
using terrain::HeightGrid;

template <auto Release>
struct Releaser {
    template <typename Handle>
    void operator()(Handle* handle) const {
        Release(handle);
    }
};
using Dataset = std::unique_ptr<void, Releaser<GDALClose>>;
using SpatialReference = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>,
                                         Releaser<OSRDestroySpatialReference>>;
using StringList = std::unique_ptr<char*, Releaser<CSLDestroy>>;

/// Keeps what GDAL would print, while it lives, on this thread; no sidecar files are written.
class QuietGdal {
public:
    QuietGdal() {
        static std::once_flag registered;
        std::call_once(registered, GDALAllRegister);
        CPLPushErrorHandlerEx(&QuietGdal::note, this);
        CPLSetThreadLocalConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO");
        CPLErrorReset();
    }
    QuietGdal(const QuietGdal&) = delete;
    QuietGdal& operator=(const QuietGdal&) = delete;
    ~QuietGdal() {
        CPLSetThreadLocalConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", nullptr);
        CPLPopErrorHandler();
    }

    /// The first failure since the last call, "" for none.
    std::string takeError() { return std::exchange(error_, {}); }

private:
    static void CPL_STDCALL note(CPLErr severity, CPLErrorNum, const char* message) {
        auto& self = *static_cast<QuietGdal*>(CPLGetErrorHandlerUserData());
        if (severity >= CE_Failure && self.error_.empty())
            self.error_ = message;
    }

    std::string error_;
};

/// What a pixel value has to go through to be metres.
struct ValueRule {
    std::optional<float> nodata;
    bool lowestIsNodata = false;  ///< -32768, in 16-bit rasters
    double scale = 1;
    double offset = 0;
};

/// Pixel to projected metres: (x, y) = origin + column * perColumn + row * perRow, from the outer
/// corner of the first pixel.
struct Georeference {
    Vec2 origin{0, 0};
    Vec2 perColumn{1, 0};
    Vec2 perRow{0, -1};
};

std::string gdalPath(const std::string& path) {
    if (path.starts_with("/vsi"))
        return path;
    if (path.ends_with(".gz"))
        return "/vsigzip/" + path;
    if (path.ends_with(".zip"))
        return "/vsizip/" + path;
    return path;
}

absl::Status invalid(const std::string& path, const std::string& what) {
    return absl::InvalidArgumentError(fmt::format("{}: {}", path, what));
}

absl::StatusOr<std::uint64_t> hashFile(const std::string& path) {
    const std::unique_ptr<VSILFILE, Releaser<VSIFCloseL>> file(VSIFOpenL(path.c_str(), "rb"));
    if (!file)
        return absl::NotFoundError(fmt::format("{}: no such file, or not readable", path));
    const std::unique_ptr<XXH64_state_t, Releaser<XXH64_freeState>> state(XXH64_createState());
    XXH64_reset(state.get(), 0);
    std::vector<char> buffer(std::size_t{1} << 20);
    while (const std::size_t got = VSIFReadL(buffer.data(), 1, buffer.size(), file.get()))
        XXH64_update(state.get(), buffer.data(), got);
    return XXH64_digest(state.get());
}

absl::StatusOr<Dataset> openRaster(const std::string& path, QuietGdal& gdal) {
    Dataset dataset(GDALOpenEx(gdalPath(path).c_str(),
                               GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                               nullptr, nullptr));
    if (!dataset)
        return invalid(path, fmt::format("is no raster that GDAL {} reads ({}); give a DEM such as "
                                         "a GeoTIFF",
                                         GDALVersionInfo("RELEASE_NAME"), gdal.takeError()));
    if (GDALGetRasterCount(dataset.get()) < 1)
        return invalid(path,
                       "has no raster band of its own; name one of its subdatasets instead "
                       "(gdalinfo lists them)");
    return dataset;
}

absl::Status checkSize(const std::string& path, int columns, int rows) {
    if (columns < 2 || rows < 2)
        return invalid(
            path, fmt::format("has {} x {} posts; a terrain needs at least 2 x 2", columns, rows));
    constexpr auto kMaxPosts = static_cast<int>(terrain::kMaxPosts);
    const std::uint64_t bytes =
        static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) * sizeof(float);
    if (columns > kMaxPosts || rows > kMaxPosts || bytes > kMaxDemBytes)
        return absl::ResourceExhaustedError(fmt::format(
            "{}: has {} x {} posts, {:.1f} GiB in memory; the limits are {} posts a side and "
            "{:.1f} GiB; import a part of it (gdal_translate -srcwin) or fewer posts (-outsize)",
            path, columns, rows, static_cast<double>(bytes) / (1 << 30), kMaxPosts,
            static_cast<double>(kMaxDemBytes) / (1 << 30)));
    return absl::OkStatus();
}

/// Refuses bands that hold something else than heights.
absl::Status checkBand(const std::string& path, GDALRasterBandH band) {
    const GDALDataType type = GDALGetRasterDataType(band);
    if (GDALDataTypeIsComplex(type))
        return invalid(path, fmt::format("band 1 holds complex numbers ({}), not heights",
                                         GDALGetDataTypeName(type)));
    const GDALColorInterp colour = GDALGetRasterColorInterpretation(band);
    if (colour == GCI_PaletteIndex || GDALGetRasterColorTable(band) != nullptr)
        return invalid(path, "band 1 holds palette indices of a picture, not heights");
    if (colour >= GCI_RedBand && colour <= GCI_YCbCr_CrBand)
        return invalid(path, fmt::format("band 1 is a picture's ({}), not heights; give a DEM",
                                         GDALGetColorInterpretationName(colour)));
    return absl::OkStatus();
}

/// Metres per unit of a band's unit tag; 1 for metres and for what it does not know.
double metresPerUnit(const std::string& unit, std::vector<std::string>& notes) {
    struct Unit {
        const char* name;
        double metres;
    };
    constexpr double kFoot = 0.3048;
    constexpr double kUsSurveyFoot = 1200.0 / 3937.0;
    constexpr std::array<Unit, 20> kUnits = {{{"", 1},
                                              {"m", 1},
                                              {"metre", 1},
                                              {"meter", 1},
                                              {"metres", 1},
                                              {"meters", 1},
                                              {"ft", kFoot},
                                              {"feet", kFoot},
                                              {"foot", kFoot},
                                              {"International foot", kFoot},
                                              {"US survey foot", kUsSurveyFoot},
                                              {"us-ft", kUsSurveyFoot},
                                              {"ftUS", kUsSurveyFoot},
                                              {"foot_survey_us", kUsSurveyFoot},
                                              {"Foot_US", kUsSurveyFoot},
                                              {"km", 1000},
                                              {"dm", 0.1},
                                              {"cm", 0.01},
                                              {"centimeters", 0.01},
                                              {"mm", 0.001}}};
    for (const Unit& known : kUnits)
        if (EQUAL(unit.c_str(), known.name)) {
            if (known.metres != 1)
                notes.push_back(fmt::format("heights in {} turned to metres", unit));
            return known.metres;
        }
    notes.push_back(fmt::format("height unit '{}' is unknown; taken for metres", unit));
    return 1;
}

absl::StatusOr<ValueRule> valueRule(const std::string& path, GDALRasterBandH band,
                                    std::vector<std::string>& notes) {
    ValueRule rule;
    int isSet = 0;
    const double nodata = GDALGetRasterNoDataValue(band, &isSet);
    if (isSet != 0)
        rule.nodata = static_cast<float>(nodata);
    rule.lowestIsNodata = GDALGetRasterDataType(band) == GDT_Int16;
    const double scale = GDALGetRasterScale(band, &isSet);
    const double offset = GDALGetRasterOffset(band, &isSet);
    if (!std::isfinite(scale) || !std::isfinite(offset) || scale == 0)
        return invalid(path, fmt::format("band 1 has scale {} and offset {}; both must be finite "
                                         "and the scale not 0",
                                         scale, offset));
    const double unit = metresPerUnit(GDALGetRasterUnitType(band), notes);
    rule.scale = scale * unit;
    rule.offset = offset * unit;
    return rule;
}

float heightOf(float value, const ValueRule& rule) {
    constexpr float kImpossible = 1e30F;
    const bool isNodata = (rule.nodata && value == *rule.nodata) ||
                          (rule.lowestIsNodata && value == -32768.0F) ||
                          !(std::abs(value) < kImpossible);
    return isNodata ? terrain::kNodata
                    : static_cast<float>(static_cast<double>(value) * rule.scale + rule.offset);
}

void clean(float* heights, std::size_t count, const ValueRule& rule) {
    for (std::size_t k = 0; k < count; ++k) heights[k] = heightOf(heights[k], rule);
}

/// Reads a band into `heights` in blocks of rows; calls each block done with its first height and
/// count of heights. Rows stay in the raster's order.
template <typename Done>
absl::Status readRows(const std::string& path, GDALRasterBandH band, std::vector<float>& heights,
                      QuietGdal& gdal, const ImportControl& control, Done done) {
    constexpr int kBlockRows = 256;
    const int columns = GDALGetRasterBandXSize(band);
    const int rows = GDALGetRasterBandYSize(band);
    heights.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; row += kBlockRows) {
        RETURN_IF_ERROR(control.check());
        const int count = std::min(kBlockRows, rows - row);
        float* first =
            heights.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
        if (GDALRasterIO(band, GF_Read, 0, row, columns, count, first, columns, count, GDT_Float32,
                         0, 0) != CE_None)
            return absl::DataLossError(
                fmt::format("{}: rows {} to {} cannot be read ({}); the file may be truncated",
                            path, row, row + count - 1, gdal.takeError()));
        done(row, first, static_cast<std::size_t>(columns) * static_cast<std::size_t>(count));
        control.report("reading", static_cast<double>(row + count) / rows);
    }
    return absl::OkStatus();
}

/// Nodata by a mask of the whole file, where there is one.
absl::Status applyMask(const std::string& path, GDALRasterBandH band, std::vector<float>& heights,
                       QuietGdal& gdal) {
    const int flags = GDALGetMaskFlags(band);
    if ((flags & (GMF_PER_DATASET | GMF_ALPHA)) == 0)
        return absl::OkStatus();
    const int columns = GDALGetRasterBandXSize(band);
    const int rows = GDALGetRasterBandYSize(band);
    std::vector<unsigned char> mask(static_cast<std::size_t>(columns));
    for (int row = 0; row < rows; ++row) {
        if (GDALRasterIO(GDALGetMaskBand(band), GF_Read, 0, row, columns, 1, mask.data(), columns,
                         1, GDT_Byte, 0, 0) != CE_None)
            return absl::DataLossError(
                fmt::format("{}: its mask cannot be read ({})", path, gdal.takeError()));
        float* first = heights.data() + static_cast<std::size_t>(row) * mask.size();
        for (std::size_t k = 0; k < mask.size(); ++k)
            if (mask[k] == 0)
                first[k] = terrain::kNodata;
    }
    return absl::OkStatus();
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

std::array<double, 6> geoTransform(const Georeference& g) {
    return {g.origin.x, g.perColumn.x, g.perRow.x, g.origin.y, g.perColumn.y, g.perRow.y};
}

std::string wktOf(OGRSpatialReferenceH reference) {
    char* text = nullptr;
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    OSRExportToWktEx(reference, &text, options);
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

/// The projected CRS for data around a longitude and latitude of `geographic`.
absl::StatusOr<SpatialReference> localProjection(const std::string& path,
                                                 OGRSpatialReferenceH geographic, double longitude,
                                                 double latitude) {
    constexpr double kUtmLimit = 84;
    SpatialReference local(OSRNewSpatialReference(nullptr));
    OGRErr error = OGRERR_NONE;
    if (std::abs(latitude) > kUtmLimit) {
        error = OSRImportFromEPSG(local.get(), latitude > 0 ? 32661 : 32761);
    } else {
        const double wrapped = longitude - 360 * std::floor((longitude + 180) / 360);
        const int zone = std::clamp(static_cast<int>((wrapped + 180) / 6) + 1, 1, 60);
        OSRSetProjCS(local.get(),
                     fmt::format("UTM zone {}{}", zone, latitude < 0 ? 'S' : 'N').c_str());
        error = OSRCopyGeogCSFrom(local.get(), geographic);
        if (error == OGRERR_NONE)
            error = OSRSetUTM(local.get(), zone, latitude >= 0 ? 1 : 0);
    }
    if (error != OGRERR_NONE)
        return invalid(path,
                       "its geographic CRS has no UTM zone; reproject it with gdalwarp first");
    OSRSetAxisMappingStrategy(local.get(), OAMS_TRADITIONAL_GIS_ORDER);
    return local;
}

/// `heights` as a GDAL dataset, without a copy.
absl::StatusOr<Dataset> asDataset(const std::string& path, std::vector<float>& heights, int columns,
                                  int rows, const Georeference& reference,
                                  OGRSpatialReferenceH crs) {
    Dataset memory(
        GDALCreate(GDALGetDriverByName("MEM"), "", columns, rows, 0, GDT_Float32, nullptr));
    if (!memory)
        return absl::InternalError(fmt::format("{}: GDAL's MEM driver is missing", path));
    const std::string pointer =
        fmt::format("DATAPOINTER={}", reinterpret_cast<std::uintptr_t>(heights.data()));
    const char* const options[] = {pointer.c_str(), nullptr};
    GDALAddBand(memory.get(), GDT_Float32, const_cast<char**>(options));
    std::array<double, 6> transform = geoTransform(reference);
    GDALSetGeoTransform(memory.get(), transform.data());
    GDALSetSpatialRef(memory.get(), crs);
    GDALSetRasterNoDataValue(GDALGetRasterBand(memory.get(), 1),
                             std::numeric_limits<double>::quiet_NaN());
    return memory;
}

/// A lazily computed reprojection of `source`.
absl::StatusOr<Dataset> reprojected(const std::string& path, GDALDatasetH source,
                                    const std::string& targetWkt, QuietGdal& gdal) {
    StringList arguments;
    for (const char* argument : {"-of", "VRT", "-r", "bilinear", "-dstnodata", "nan", "-et", "0.01",
                                 "-wo", "NUM_THREADS=ALL_CPUS", "-t_srs", targetWkt.c_str()})
        arguments.reset(CSLAddString(arguments.release(), argument));
    const std::unique_ptr<GDALWarpAppOptions, Releaser<GDALWarpAppOptionsFree>> options(
        GDALWarpAppOptionsNew(arguments.get(), nullptr));
    GDALDatasetH sources[] = {source};
    int usageError = 0;
    Dataset warped(GDALWarp("", nullptr, 1, sources, options.get(), &usageError));
    if (!warped)
        return invalid(path, fmt::format("cannot be reprojected to UTM ({}); reproject it with "
                                         "gdalwarp first",
                                         gdal.takeError()));
    return warped;
}

/// Turns rows over where that makes lattice and ground both right-handed, and fills in `grid`.
void orient(const Georeference& g, int columns, int rows, std::vector<float> heights,
            HeightGrid& grid) {
    grid.columns = columns;
    grid.rows = rows;
    grid.heights = std::move(heights);
    grid.perColumn = g.perColumn;
    grid.perRow = g.perRow;
    grid.origin = g.origin + (g.perColumn + g.perRow) * 0.5;  // centre of the first pixel
    if (g.perColumn.x * g.perRow.y - g.perColumn.y * g.perRow.x > 0)
        return;
    grid.origin += g.perRow * static_cast<double>(rows - 1);
    grid.perRow = Vec2(0.0) - g.perRow;  // no negative zeros
    for (int j = 0; j < rows / 2; ++j)
        std::swap_ranges(grid.row(j), grid.row(j) + columns, grid.row(rows - 1 - j));
}

/// A DEM in degrees: reprojects what was read.
absl::Status reprojectInto(const std::string& path, std::vector<float> heights, int columns,
                           int rows, const Georeference& degrees, OGRSpatialReferenceH crs,
                           QuietGdal& gdal, const ImportControl& control, Dem& dem) {
    constexpr double kMaxDegrees = 30;
    const Vec2 across = degrees.perColumn * static_cast<double>(columns);
    const Vec2 down = degrees.perRow * static_cast<double>(rows);
    const Vec2 span = glm::abs(across) + glm::abs(down);
    const Vec2 centre = degrees.origin + (across + down) * 0.5;
    if (std::max(span.x, span.y) > kMaxDegrees || std::abs(centre.y) > 90)
        return invalid(path,
                       fmt::format("spans {:.1f} x {:.1f} degrees around latitude {:.1f}, too "
                                   "much for one UTM zone (at most {}); reproject it with "
                                   "gdalwarp -t_srs first",
                                   span.x, span.y, centre.y, kMaxDegrees));
    ASSIGN_OR_RETURN(const SpatialReference local, localProjection(path, crs, centre.x, centre.y));
    ASSIGN_OR_RETURN(const Dataset source, asDataset(path, heights, columns, rows, degrees, crs));
    ASSIGN_OR_RETURN(const Dataset warped,
                     reprojected(path, source.get(), wktOf(local.get()), gdal));
    const int newColumns = GDALGetRasterXSize(warped.get());
    const int newRows = GDALGetRasterYSize(warped.get());
    RETURN_IF_ERROR(checkSize(path, newColumns, newRows));
    std::vector<float> result;
    RETURN_IF_ERROR(
        readRows(path, GDALGetRasterBand(warped.get(), 1), result, gdal, control,
                 [](int, float* first, std::size_t count) { clean(first, count, {}); }));
    std::vector<std::string> none;
    ASSIGN_OR_RETURN(const Georeference metres, georeferenceOf(path, warped.get(), none));
    dem.crsWkt = wktOf(local.get());
    dem.notes.push_back(fmt::format("degrees reprojected to {}: {} x {} posts, {:.4g} m apart",
                                    OSRGetName(local.get()), newColumns, newRows,
                                    metres.perColumn.x));
    orient(metres, newColumns, newRows, std::move(result), dem.grid);
    return absl::OkStatus();
}

bool hasData(const std::vector<float>& heights) {
    return std::any_of(heights.begin(), heights.end(), [](float h) { return h == h; });
}

}  // namespace

absl::StatusOr<Dem> readDem(const std::string& path, const ImportControl& control) {
    QuietGdal gdal;
    Dem dem;
    control.report("reading", 0);
    ASSIGN_OR_RETURN(dem.sourceHash, hashFile(path));
    ASSIGN_OR_RETURN(const Dataset dataset, openRaster(path, gdal));
    const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
    const int columns = GDALGetRasterXSize(dataset.get());
    const int rows = GDALGetRasterYSize(dataset.get());
    RETURN_IF_ERROR(checkSize(path, columns, rows));
    RETURN_IF_ERROR(checkBand(path, band));
    if (GDALGetRasterCount(dataset.get()) > 1)
        dem.notes.push_back(
            fmt::format("band 1 of {} taken for heights", GDALGetRasterCount(dataset.get())));
    ASSIGN_OR_RETURN(const ValueRule rule, valueRule(path, band, dem.notes));
    ASSIGN_OR_RETURN(Georeference reference, georeferenceOf(path, dataset.get(), dem.notes));

    std::vector<float> heights;
    RETURN_IF_ERROR(
        readRows(path, band, heights, gdal, control,
                 [&](int, float* first, std::size_t count) { clean(first, count, rule); }));
    RETURN_IF_ERROR(applyMask(path, band, heights, gdal));
    if (!hasData(heights))
        return invalid(path, "all posts are nodata; check the band's nodata value");

    const OGRSpatialReferenceH crs = GDALGetSpatialRef(dataset.get());
    if (crs != nullptr && OSRIsGeographic(crs) != 0) {
        RETURN_IF_ERROR(reprojectInto(path, std::move(heights), columns, rows, reference, crs, gdal,
                                      control, dem));
        if (!hasData(dem.grid.heights))
            return invalid(path,
                           "reprojection to UTM left no post with data; reproject it with "
                           "gdalwarp first");
        return dem;
    }
    if (crs != nullptr) {
        dem.crsWkt = wktOf(crs);
        const double metres = OSRGetLinearUnits(crs, nullptr);
        if (metres != 1 && metres > 0 && std::isfinite(metres)) {
            reference = {reference.origin * metres, reference.perColumn * metres,
                         reference.perRow * metres};
            dem.notes.push_back(fmt::format("CRS unit of {} m turned to metres", metres));
        }
    }
    orient(reference, columns, rows, std::move(heights), dem.grid);
    return dem;
}

absl::Status writeGeoTiff(const HeightGrid& grid, const std::string& path) {
    const auto folder = std::filesystem::absolute(path).parent_path();
    if (std::error_code ignored; !std::filesystem::is_directory(folder, ignored))
        return absl::NotFoundError(fmt::format(
            "{}: cannot create it: {} is no folder; create it first", path, folder.string()));
    QuietGdal gdal;
    const std::string partial = fmt::format("{}.partial-{}", path, getpid());
    const auto failed = [&](const char* what) {
        std::remove(partial.c_str());
        return absl::UnavailableError(fmt::format("{}: {} ({})", path, what, gdal.takeError()));
    };
    {
        const Dataset file(GDALCreate(GDALGetDriverByName("GTiff"), partial.c_str(), grid.columns,
                                      grid.rows, 1, GDT_Float32, nullptr));
        if (!file)
            return failed("cannot be written");
        const Vec2 corner = grid.origin - (grid.perColumn - grid.perRow) * 0.5 +
                            grid.perRow * static_cast<double>(grid.rows - 1);
        std::array<double, 6> transform = geoTransform({corner, grid.perColumn, -grid.perRow});
        const SpatialReference crs(OSRNewSpatialReference(nullptr));
        constexpr int kUtm33North = 32633;
        OSRImportFromEPSG(crs.get(), kUtm33North);
        const GDALRasterBandH band = GDALGetRasterBand(file.get(), 1);
        GDALSetGeoTransform(file.get(), transform.data());
        GDALSetSpatialRef(file.get(), crs.get());
        GDALSetRasterNoDataValue(band, std::numeric_limits<double>::quiet_NaN());
        // Rows from the last to the first: a negative line spacing turns the grid over.
        const auto stride = static_cast<GSpacing>(sizeof(float)) * grid.columns;
        if (GDALRasterIOEx(band, GF_Write, 0, 0, grid.columns, grid.rows,
                           const_cast<float*>(grid.row(grid.rows - 1)), grid.columns, grid.rows,
                           GDT_Float32, sizeof(float), -stride, nullptr) != CE_None)
            return failed("cannot be written");
    }
    if (const std::string error = gdal.takeError(); !error.empty()) {
        std::remove(partial.c_str());
        return absl::UnavailableError(fmt::format("{}: cannot be written ({})", path, error));
    }
    if (std::rename(partial.c_str(), path.c_str()) != 0)
        return failed("cannot be renamed from its partial file");
    return absl::OkStatus();
}

}  // namespace eyrie::import
