// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/terrain/eyt_format.h"
#include "tests/renderer/import/imagery_fixture.h"

/// Pictures laid over a terrain: what is stored is compared with formulas over the ground,
/// evaluated where the texels lie.
namespace eyrie::import {

/// BC1's own error on the smooth colours below, and the rounding of two resamplings.
inline constexpr int kTolerance = 10;

inline std::uint8_t wave(double metres, double period) {
    return static_cast<std::uint8_t>(std::lround(128 + 100 * std::sin(2 * M_PI * metres / period)));
}

/// Colours that tell x from y and change slowly over `period` metres.
inline std::function<fabric::Rgba(double, double)> waves(double period) {
    return [period](double x, double y) {
        return fabric::Rgba{wave(x - test::kWest, period), wave(y - test::kSouth, period * 1.3), 90,
                            255};
    };
}

inline int difference(const fabric::Rgba& a, const fabric::Rgba& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

class ImageryImport : public testing::Test {
protected:
    std::string write(const test::Picture& picture, const std::string& name = "picture.tif") {
        const std::string path = folder_.path(name);
        test::writePicture(path, picture);
        return path;
    }

    /// picture.tif as a raster of so many pixels a side, of which `place` says where it is.
    void writeVrt(const std::string& name, int side, const std::string& place) {
        std::ofstream(folder_.path(name))
            << "<VRTDataset rasterXSize=\"" << side << "\" rasterYSize=\"" << side << "\">" << place
            << "<VRTRasterBand dataType=\"Byte\" band=\"1\"><SimpleSource>"
               "<SourceFilename relativeToVRT=\"1\">picture.tif</SourceFilename>"
               "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    }

    /// Around all of a terrain of so many metres, and a little more.
    static test::Picture over(double metresX, double metresY, double pixel,
                              std::function<fabric::Rgba(double, double)> colour) {
        const double margin = 4 * pixel;
        return {.west = test::kWest - margin,
                .north = test::kSouth + metresY + margin,
                .pixel = pixel,
                .columns = static_cast<int>(std::ceil((metresX + 2 * margin) / pixel)),
                .rows = static_cast<int>(std::ceil((metresY + 2 * margin) / pixel)),
                .colour = std::move(colour)};
    }

    std::shared_ptr<const terrain::EytFile> imported(const terrain::HeightGrid& grid,
                                                     const std::vector<std::string>& pictures) {
        auto file = test::importedWith(grid, pictures, folder_);
        EXPECT_TRUE(file.ok()) << file.status();
        return file.ok() ? *file : nullptr;
    }

    absl::Status importError(const terrain::HeightGrid& grid,
                             const std::vector<std::string>& pictures) {
        return test::importedWith(grid, pictures, folder_).status();
    }

    /// Compares texels whose middle lies in the grid with `colour`; holes wherever that has alpha
    /// 0.
    static void expectColours(const terrain::EytFile& file, double postMetres,
                              const std::function<fabric::Rgba(double, double)>& colour,
                              int tolerance = kTolerance) {
        const terrain::TexturePyramid& pyramid = file.index().imagery->pyramid;
        const test::TexelImage image = test::wholeLevel(file, 0);
        const double texel = postMetres * pyramid.texelPosts(0);
        int wrong = 0;
        for (std::int64_t y = 0; y < image.height; ++y)
            for (std::int64_t x = 0; x < image.width; ++x) {
                const fabric::Rgba expected =
                    colour(test::kWest + (static_cast<double>(x) + 0.5) * texel,
                           test::kSouth + (static_cast<double>(y) + 0.5) * texel);
                const fabric::Rgba& found = image.at(x, y);
                if (expected.a == found.a &&
                    (found.a == 0 || difference(expected, found) <= tolerance))
                    continue;
                if (++wrong < 5)
                    ADD_FAILURE() << x << ", " << y << ": " << +found.r << ' ' << +found.g << ' '
                                  << +found.b << ' ' << +found.a << ", expected " << +expected.r
                                  << ' ' << +expected.g << ' ' << +expected.b << ' ' << +expected.a;
            }
        EXPECT_EQ(wrong, 0) << "of " << image.texels.size();
    }

    test::TemporaryFolder folder_;
};

}  // namespace eyrie::import
