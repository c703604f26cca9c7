// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/renderer/import/terrain_fixture.h"

namespace eyrie::test {

inline constexpr int kUtm32 = 32632;
inline constexpr int kDegrees = 4326;

/// A raster whose pixels are `height` of their centres' coordinates.
struct Raster {
    int epsg = kUtm32;
    const char* crs = nullptr;  ///< instead, such as EPSG:26910+6360
    const char* driver = "GTiff";
    double west = 0;
    double north = 0;
    double pixel = 10;
    int columns = 10;
    int rows = 10;
    std::function<double(double, double)> height;
    double nodata = -9999;
    const char* unit = "";
    double scale = 1;
    double offset = 0;
    bool isDouble = false;  ///< of 64 bits, not 32
};

/// Rasters in a folder of the test's own, to be read as one terrain.
class DemMosaic : public testing::Test {
protected:
    /// Writes `raster` to a file of its own and returns the path.
    std::string write(const Raster& raster);

    static std::function<double(double, double)> constant(double height) {
        return [height](double, double) { return height; };
    }

    TemporaryFolder folder_;
    int files_ = 0;
};

}  // namespace eyrie::test
