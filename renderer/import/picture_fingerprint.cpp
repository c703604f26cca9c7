// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/picture_fingerprint.h"

#include <array>
#include <memory>
#include <optional>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <xxhash.h>

#include "renderer/import/gdal_handles.h"
#include "renderer/import/raster_file.h"
#include "renderer/import/raster_name.h"
#include "renderer/page/remote_name.h"

namespace eyrie::import {
namespace {

constexpr std::size_t kEnd = std::size_t{1} << 20;

/// Of small pieces all over what lies between the ends of a file; `seed` where nothing does.
std::uint64_t fingerprintOfMiddle(VSILFILE* file, vsi_l_offset bytes, std::uint64_t seed) {
    constexpr vsi_l_offset kPieces = 64;
    std::array<char, 4096> piece{};
    const vsi_l_offset middle = bytes > 2 * kEnd ? bytes - 2 * kEnd : 0;
    std::uint64_t all = seed;
    for (vsi_l_offset k = 0; k < kPieces && middle > 0; ++k) {
        VSIFSeekL(file, kEnd + middle * k / kPieces, SEEK_SET);
        all = XXH64(piece.data(), VSIFReadL(piece.data(), 1, piece.size(), file), all);
    }
    return all;
}

/// None of what is no file.
std::optional<std::uint64_t> fingerprintOfFile(const std::string& path) {
    const std::unique_ptr<VSILFILE, Releaser<VSIFCloseL>> file(VSIFOpenL(path.c_str(), "rb"));
    if (!file)
        return std::nullopt;
    std::vector<char> buffer(kEnd);
    std::size_t got = VSIFReadL(buffer.data(), 1, kEnd, file.get());
    const std::uint64_t first = XXH64(buffer.data(), got, 1);
    VSIFSeekL(file.get(), 0, SEEK_END);
    const vsi_l_offset bytes = VSIFTellL(file.get());
    VSIFSeekL(file.get(), bytes > kEnd ? bytes - kEnd : 0, SEEK_SET);
    got = VSIFReadL(buffer.data(), 1, kEnd, file.get());
    return XXH64(buffer.data(), got, fingerprintOfMiddle(file.get(), bytes, first ^ bytes));
}

/// Of the picture's own file and of all that it names or has beside it.
std::uint64_t fingerprintOf(const std::string& name) {
    const std::optional<std::uint64_t> own = fingerprintOfFile(name);
    const std::string part = partOfFile(name);  // of a file that GDAL alone can tell
    std::uint64_t all = own ? *own : XXH64(part.data(), part.size(), 0);
    if (const Dataset dataset(GDALOpen(name.c_str(), GA_ReadOnly)); dataset)
        for (const std::string& file : allFilesOf(dataset.get()))
            if (!own || file != name)
                all = all * 0x9e3779b97f4a7c15 + fingerprintOfFile(file).value_or(0);
    return all;
}

std::string stampOf(const std::string& file) {
    VSIStatBufL status;
    if (VSIStatL(file.c_str(), &status) != 0)
        return file + '\n';
    return fmt::format("{} {} {}.{}\n", file, status.st_size, status.st_mtim.tv_sec,
                       status.st_mtim.tv_nsec);
}

}  // namespace

std::uint64_t pictureFingerprint(const std::vector<std::string>& paths) {
    const QuietGdal quiet;
    std::uint64_t all = 0;
    for (const std::string& path : paths)
        all = all * 0x9e3779b97f4a7c15 + fingerprintOf(page::gdalName(path));
    return all;
}

std::uint64_t pictureStamp(const std::vector<std::string>& paths) {
    const QuietGdal quiet;
    std::string all;
    for (const std::string& path : paths) {
        const std::string name = page::gdalName(path);
        all += stampOf(name);
        if (const Dataset dataset(GDALOpen(name.c_str(), GA_ReadOnly)); dataset)
            for (const std::string& file : allFilesOf(dataset.get())) all += stampOf(file);
    }
    return XXH64(all.data(), all.size(), 0);
}

}  // namespace eyrie::import
