// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/raster_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <absl/strings/ascii.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "fabric/status.h"
#include "renderer/page/remote_name.h"

namespace eyrie::import {
namespace {

/// A mosaic keeps all of its rasters open, and programs begin with 1024 files as a rule.
void allowManyOpenFiles() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == limit.rlim_max)
        return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

/// The files of a .zip, by names that openRaster takes.
std::vector<std::string> filesInside(const std::string& path) {
    const std::string archive = gdalPath(path);
    if (!archive.starts_with("/vsizip/"))
        return {};
    std::vector<std::string> files;
    const std::unique_ptr<char*, Releaser<CSLDestroy>> names(VSIReadDirRecursive(archive.c_str()));
    for (char** name = names.get(); name != nullptr && *name != nullptr; ++name)
        if (!std::string_view(*name).ends_with('/'))
            files.push_back(fmt::format("{}/{}", archive, *name));
    return files;
}

/// A raster among the files of a .zip, by a name that openRaster takes; "": there is none.
std::string rasterInside(const std::string& path) {
    for (std::string& file : filesInside(path))
        if (GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr)
            return std::move(file);
    return "";
}

/// Whether there are bytes under this name, here or at an address.
bool hasBytes(const std::string& path) {
    VSIStatBufL status;
    return VSIStatL(page::gdalName(path).c_str(), &status) == 0;
}

Dataset opened(const std::string& name) {
    return Dataset(GDALOpenEx(name.c_str(),
                              GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                              nullptr, nullptr));
}

absl::Status cannotBeOpened(const std::string& path, const char* wanted, QuietGdal& gdal) {
    RETURN_IF_ERROR(checkOpenFiles(path));
    const std::string error = gdal.takeError();
    if (!hasBytes(path))
        return absl::NotFoundError(
            fmt::format("{}: no such file, or not readable ({})", path, error));
    const bool areSeveral = filesInside(path).size() > 1;
    if (const std::string inside = areSeveral ? rasterInside(path) : ""; !inside.empty())
        return invalid(path, fmt::format("holds more than one file; name the raster that is meant, "
                                         "such as {}",
                                         inside));
    return invalid(path, fmt::format("is no raster that GDAL {} reads ({}); give {}",
                                     GDALVersionInfo("RELEASE_NAME"), error, wanted));
}

bool isOfDriver(GDALDatasetH raster, const char* name) {
    const GDALDriverH driver = GDALGetDatasetDriver(raster);
    return driver != nullptr && EQUAL(GDALGetDriverShortName(driver), name);
}

/// DataLoss for a file of ENVI that is shorter than its header says: GDAL takes what such a file
/// lacks for zeros that were never written.
absl::Status checkWholeFile(const std::string& path, GDALDatasetH raster) {
    const auto said = [raster](const char* field) -> std::uint64_t {
        const char* const text = GDALGetMetadataItem(raster, field, "ENVI");
        return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
    };
    if (!isOfDriver(raster, "ENVI") || said("file_compression") != 0)
        return absl::OkStatus();
    std::uint64_t expected = 1;
    for (const int factor :
         {GDALGetRasterXSize(raster), GDALGetRasterYSize(raster), GDALGetRasterCount(raster),
          GDALGetDataTypeSizeBytes(GDALGetRasterDataType(GDALGetRasterBand(raster, 1)))})
        expected *= static_cast<std::uint64_t>(factor);
    expected += said("header_offset");
    VSIStatBufL status;
    if (VSIStatL(gdalPath(path).c_str(), &status) != 0 ||
        static_cast<std::uint64_t>(status.st_size) >= expected)
        return absl::OkStatus();
    return absl::DataLossError(fmt::format("{}: has {} bytes, and {} by its header; {}", path,
                                           status.st_size, expected, whyUnreadable(path)));
}

/// The same of a raster, and of all that a virtual one refers to.
absl::Status checkWhole(const std::string& path, GDALDatasetH raster) {
    RETURN_IF_ERROR(checkWholeFile(path, raster));
    if (!isOfDriver(raster, "VRT"))
        return absl::OkStatus();
    const QuietGdal gdal;  // what is missing is found when it is read
    for (const std::string& file : allFilesOf(raster))
        if (const Dataset source(
                GDALOpenEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr, nullptr));
            source)
            RETURN_IF_ERROR(checkWholeFile(file, source.get()));
    return absl::OkStatus();
}

}  // namespace

std::string gdalPath(const std::string& path) {
    if (path.starts_with("/vsi"))
        return path;
    const std::string name = page::gdalName(path);
    const std::string plain = absl::AsciiStrToLower(page::withoutQuery(path));
    if (plain.ends_with(".gz"))
        return "/vsigzip/" + name;
    if (plain.ends_with(".zip"))  // in braces it may go on after that
        return plain.size() == path.size() ? "/vsizip/" + name : "/vsizip/{" + name + '}';
    return name;
}

absl::StatusOr<Dataset> openRaster(const std::string& path, const char* wanted, QuietGdal& gdal) {
    RETURN_IF_ERROR(page::checkScheme(path));
    allowManyOpenFiles();
    Dataset dataset = opened(gdalPath(path));
    // By its plain address GDAL loads all of a file into memory, which serves where a server sends
    // no parts.
    if (!dataset && page::gdalName(path) != path && hasBytes(path))
        dataset = opened(path);
    // Formats that go by a file's name, as SRTM's do, know it by the one inside.
    if (const std::vector<std::string> files =
            dataset ? std::vector<std::string>() : filesInside(path);
        files.size() == 1)
        dataset = opened(files.front());
    if (!dataset)
        return cannotBeOpened(path, wanted, gdal);
    if (GDALGetRasterCount(dataset.get()) < 1) {
        const char* const first =
            GDALGetMetadataItem(dataset.get(), "SUBDATASET_1_NAME", "SUBDATASETS");
        return invalid(path, fmt::format("has no raster band of its own; name one of its "
                                         "subdatasets instead{} (gdalinfo lists them)",
                                         first ? fmt::format(", such as {}", first) : ""));
    }
    RETURN_IF_ERROR(checkWhole(path, dataset.get()));
    return dataset;
}

absl::Status checkPlace(const std::string& path, GDALDatasetH raster) {
    std::array<double, 6> ignored{};
    if (GDALGetGeoTransform(raster, ignored.data()) == CE_None)
        return absl::OkStatus();
    const auto needsWarp = [&](const char* what, const char* option) {
        return invalid(path, fmt::format("says where it is by {}, not by a geotransform; bring it "
                                         "to a grid first (gdalwarp{})",
                                         what, option));
    };
    if (GDALGetGCPCount(raster) > 0)
        return needsWarp("ground control points", "");
    if (GDALGetMetadata(raster, "RPC") != nullptr)
        return needsWarp("rational polynomials (RPC)", " -rpc");
    if (GDALGetMetadata(raster, "GEOLOCATION") != nullptr)
        return needsWarp("arrays of coordinates (GEOLOCATION)", " -geoloc");
    return absl::OkStatus();
}

absl::Status checkOpenFiles(const std::string& path) {
    std::array<int, 4> files{};  // as many as a raster may need to be looked at
    bool isEnough = true;
    for (int& file : files) {
        file = open("/dev/null", O_RDONLY | O_CLOEXEC);
        isEnough = isEnough && file >= 0;
    }
    for (const int file : files)
        if (file >= 0)
            close(file);
    if (isEnough)
        return absl::OkStatus();
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    return absl::ResourceExhaustedError(
        fmt::format("{}: cannot be opened beside what this process has open, at most {} files; "
                    "allow more (ulimit -n), or make one raster of several first (gdalbuildvrt)",
                    path, limit.rlim_cur));
}

std::string whyUnreadable(const std::string& path) {
    return page::isRemote(path) ? "its server may have failed; look at that and the network, then "
                                  "run the same command again"
                                : "the file may be truncated";
}

std::vector<std::string> filesOf(GDALDatasetH raster) {
    const std::unique_ptr<char*, Releaser<CSLDestroy>> list(GDALGetFileList(raster));
    std::vector<std::string> files;
    for (char** file = list.get(); file != nullptr && *file != nullptr; ++file)
        files.emplace_back(*file);
    return files;
}

std::vector<std::string> allFilesOf(GDALDatasetH raster) {
    std::vector<std::string> files = filesOf(raster);
    std::set<std::string> known(files.begin(), files.end());
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!files[i].ends_with(".vrt"))
            continue;
        const Dataset inner(
            GDALOpenEx(files[i].c_str(), GDAL_OF_RASTER, nullptr, nullptr, nullptr));
        if (!inner)
            continue;  // what it lacks is found when it is read
        for (std::string& file : filesOf(inner.get()))
            if (known.insert(file).second)
                files.push_back(std::move(file));
    }
    return files;
}

}  // namespace eyrie::import
