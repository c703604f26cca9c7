// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/raster_name.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

class RasterName : public testing::Test {
protected:
    void SetUp() override {
        fs::current_path(folder_.path(""));
        std::ofstream("heights.gpkg") << "some";
        std::ofstream("alps") << "a file that is called as a table is";
    }
    void TearDown() override { fs::current_path(before_); }

    const fs::path before_ = fs::current_path();
    test::TemporaryFolder folder_;
};

TEST_F(RasterName, IsThereWhereItsFileIs) {
    for (const char* name : {"heights.gpkg", "GPKG:heights.gpkg:alps", "NETCDF:\"heights.gpkg\":z",
                             "HDF5:\"heights.gpkg\"://group/z"})
        EXPECT_TRUE(isThere(name)) << name;
    for (const char* name : {"none.gpkg", "GPKG:none.gpkg:pyrenees", "WCS:http://host", ""})
        EXPECT_FALSE(isThere(name)) << name;
}

TEST_F(RasterName, IsFoundFromOtherFoldersWhenItIsAbsolute) {
    const std::string file = fs::current_path() / "heights.gpkg";
    EXPECT_EQ(absoluteName("./heights.gpkg"), file);
    EXPECT_EQ(absoluteName("GPKG:heights.gpkg:alps"), "GPKG:" + file + ":alps");
    EXPECT_EQ(absoluteName("NETCDF:\"heights.gpkg\":z"), "NETCDF:\"" + file + "\":z");
    EXPECT_EQ(absoluteName("WCS:http://host/a"), "WCS:http://host/a") << "no file";
    EXPECT_EQ(absoluteName("none.tif"), (fs::current_path() / "none.tif").string());
}

TEST_F(RasterName, ItsPartIsTheSameWhereverTheFileLies) {
    EXPECT_EQ(partOfFile("heights.gpkg"), "");
    EXPECT_EQ(partOfFile("GPKG:heights.gpkg:alps"), "GPKG::alps");
    EXPECT_EQ(partOfFile(absoluteName("GPKG:heights.gpkg:alps")), "GPKG::alps");
}

}  // namespace
}  // namespace eyrie::import
