// SPDX-License-Identifier: Apache-2.0
// Pictures that are decoded whole or not at all.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/imagery_source.h"
#include "renderer/import/whole_decoding.h"
#include "tests/renderer/import/imagery_import.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::uint64_t kSide = 9000;

class ImageryDecodedWhole : public ImageryImport {
protected:
    /// A picture of 64 x 48 pixels in a format of GDAL's.
    std::string writeAs(const char* format, int bands, const char* option) {
        GDALAllRegister();
        GDALDriverManager& drivers = *GetGDALDriverManager();
        const GDALDatasetUniquePtr picture(
            drivers.GetDriverByName("MEM")->Create("", 64, 48, bands, GDT_Byte, nullptr));
        std::string path = folder_.path(std::string("picture.") + format);
        CPLStringList options;
        options.AddString(option);
        const GDALDatasetUniquePtr file(drivers.GetDriverByName(format)->CreateCopy(
            path.c_str(), picture.get(), FALSE, options.List(), nullptr, nullptr));
        EXPECT_NE(file, nullptr) << format;
        return path;
    }

    static std::uint64_t bytesOf(const std::string& path) {
        const GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str()));
        return wholeDecodingBytes(GDALDataset::ToHandle(file.get()));
    }

    /// A JPEG of kSide squared grey pixels that ends where they should begin: in one scan
    /// (`frame` 0xc0) or several (0xc2).
    std::string writeHead(std::uint8_t frame) {
        constexpr auto kHigh = static_cast<std::uint8_t>(kSide >> 8);
        constexpr auto kLow = static_cast<std::uint8_t>(kSide & 255);
        const std::vector<std::uint8_t> bytes = {
            0xff, 0xd8, 0xff, frame, 0, 11, 8, kHigh, kLow, kHigh, kLow, 1, 1,
            0x11, 0,    0xff, 0xda,  0, 8,  1, 1,     0,    0,     0,    0};
        std::string path = folder_.path("grey.jpg");
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
        return path;
    }
};

TEST_F(ImageryDecodedWhole, TakesWhatTheFormatTellsOfIt) {
    constexpr std::uint64_t kPixels = 64 * 48;
    EXPECT_EQ(bytesOf(writeAs("JPEG", 3, "PROGRESSIVE=ON")), 2 * kPixels * 3 / 2)
        << "colours of half the width and height";
    EXPECT_EQ(bytesOf(writeAs("JPEG", 1, "PROGRESSIVE=ON")), 2 * kPixels);
    EXPECT_EQ(bytesOf(writeAs("JPEG", 3, "PROGRESSIVE=OFF")), 0U);
    std::string path = writeAs("WEBP", 3, "LOSSLESS=NO");
    EXPECT_EQ(bytesOf(path), 3 * kPixels + std::filesystem::file_size(path));
    path = writeAs("WEBP", 3, "LOSSLESS=YES");
    EXPECT_EQ(bytesOf(path), 7 * kPixels + std::filesystem::file_size(path));
    EXPECT_EQ(bytesOf(writeAs("GIF", 1, "INTERLACING=YES")), kPixels);
    EXPECT_GT(bytesOf(writeAs("JP2OpenJPEG", 3, "BLOCKXSIZE=64")), 3 * kPixels);
    EXPECT_EQ(bytesOf(writeAs("JP2OpenJPEG", 3, "BLOCKXSIZE=32")), 0U);
    EXPECT_EQ(bytesOf(writeAs("PNG", 3, "ZLEVEL=1")), 0U);
    EXPECT_EQ(bytesOf(writeAs("GTiff", 3, "TILED=YES")), 0U);
}

TEST_F(ImageryDecodedWhole, IsRefusedAtOnceWhereItDoesNotFitTheMemory) {
    const auto errorOf = [&](std::uint8_t frame, std::uint64_t memoryBytes) {
        return test::importedWith(test::slope(300, 300, 10), {writeHead(frame)}, folder_,
                                  {.memoryBytes = memoryBytes})
            .status();
    };
    const absl::Status status = errorOf(0xc2, 256 * kMiB);
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
    EXPECT_THAT(status.ToString(),
                testing::AllOf(HasSubstr("grey.jpg: can only be decoded whole, which takes 155 MB"),
                               HasSubstr("--memory leaves"), HasSubstr("TILED=YES")));
    // Of these the pixels are missed.
    EXPECT_EQ(errorOf(0xc2, 512 * kMiB).code(), absl::StatusCode::kDataLoss);
    EXPECT_EQ(errorOf(0xc0, 256 * kMiB).code(), absl::StatusCode::kDataLoss);
}

TEST_F(ImageryDecodedWhole, CountsAsWhatReadingTakes) {
    const terrain::GridFrame ground = test::slope(300, 300, 10).frame();
    const auto readingBytes = [&](std::uint8_t frame) {
        const auto imagery = openImagery({writeHead(frame)}, ground, "", 512 * kMiB, {});
        EXPECT_TRUE(imagery.ok()) << imagery.status();
        return imagery.ok() ? imagery->texels->readingBytes() : 0;
    };
    EXPECT_EQ(readingBytes(0xc2), readingBytes(0xc0) + 2 * kSide * kSide);
}

}  // namespace
}  // namespace eyrie::import
