// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fabric/image.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/height_grid.h"
#include "tests/renderer/import/terrain_fixture.h"

namespace eyrie::test {

inline constexpr int kUtm33 = 32633;

/// A GeoTIFF of four bands, each pixel `colour` of its centre's coordinates.
struct Picture {
    int epsg = kUtm33;  ///< 0: no CRS
    double west = 0;
    double north = 0;
    double pixel = 1;
    int columns = 1;
    int rows = 1;
    std::function<fabric::Rgba(double x, double y)> colour;
    bool isGeoreferenced = true;
};
void writePicture(const std::string& path, const Picture& picture);

/// A gentle slope on UTM 33 whose posts stand at x, y = 500000, 5000000 and on.
terrain::HeightGrid slope(std::int32_t columns, std::int32_t rows, double postMetres);
inline constexpr double kWest = 500'000;
inline constexpr double kSouth = 5'000'000;

/// Writes `grid` as a DEM, imports it with `pictures` and opens the result.
absl::StatusOr<std::shared_ptr<const terrain::EytFile>> importedWith(
    const terrain::HeightGrid& grid, const std::vector<std::string>& pictures,
    const TemporaryFolder& folder, import::TerrainImportOptions options = {});

/// A whole level of a file's imagery, decoded, without borders; holes are 0, 0, 0, 0.
struct TexelImage {
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::vector<fabric::Rgba> texels;

    const fabric::Rgba& at(std::int64_t x, std::int64_t y) const {
        return texels[static_cast<std::size_t>(y * width + x)];
    }
};
TexelImage wholeLevel(const terrain::EytFile& file, int level);

}  // namespace eyrie::test
