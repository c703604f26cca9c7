// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/import/imagery_fixture.h"

#include <algorithm>
#include <array>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "fabric/status.h"
#include "renderer/import/geotiff_writer.h"
#include "renderer/terrain/imagery/bc1.h"

namespace eyrie::test {

void writePicture(const std::string& path, const Picture& picture) {
    GDALAllRegister();
    const GDALDatasetUniquePtr file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), picture.columns, picture.rows, 4, GDT_Byte, nullptr));
    std::array<double, 6> transform{picture.west,  picture.pixel, 0, picture.north, 0,
                                    -picture.pixel};
    if (picture.isGeoreferenced)
        file->SetGeoTransform(transform.data());
    if (picture.epsg != 0) {
        OGRSpatialReference crs;
        crs.importFromEPSG(picture.epsg);
        file->SetSpatialRef(&crs);
    }
    file->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    std::vector<fabric::Rgba> row(static_cast<std::size_t>(picture.columns));
    for (int j = 0; j < picture.rows; ++j) {
        for (int i = 0; i < picture.columns; ++i)
            row[static_cast<std::size_t>(i)] =
                picture.colour(picture.west + (i + 0.5) * picture.pixel,
                               picture.north - (j + 0.5) * picture.pixel);
        ASSERT_EQ(file->RasterIO(GF_Write, 0, j, picture.columns, 1, row.data(), picture.columns, 1,
                                 GDT_Byte, 4, nullptr, 4, 4 * picture.columns, 1, nullptr),
                  CE_None);
    }
}

terrain::HeightGrid slope(std::int32_t columns, std::int32_t rows, double postMetres) {
    terrain::HeightGrid grid{.columns = columns,
                             .rows = rows,
                             .heights = {},
                             .origin = {kWest, kSouth},
                             .perColumn = {postMetres, 0},
                             .perRow = {0, postMetres}};
    for (std::int32_t j = 0; j < rows; ++j)
        for (std::int32_t i = 0; i < columns; ++i)
            grid.heights.push_back(static_cast<float>(100 + i % 7 + j));
    return grid;
}

absl::StatusOr<std::shared_ptr<const terrain::EytFile>> importedWith(
    const terrain::HeightGrid& grid, const std::vector<std::string>& pictures,
    const TemporaryFolder& folder, import::TerrainImportOptions options) {
    const std::string dem = folder.path("dem.tif");
    const std::string out = folder.path("with.eyt");
    RETURN_IF_ERROR(import::writeGeoTiff(grid, dem));
    options.imagery = pictures;
    RETURN_IF_ERROR(import::importTerrain({dem}, out, options, {}).status());
    return terrain::EytFile::open(out);
}

TexelImage wholeLevel(const terrain::EytFile& file, int level) {
    const terrain::ImageryIndex& imagery = *file.index().imagery;
    const terrain::TexturePyramid& pyramid = imagery.pyramid;
    TexelImage image{pyramid.width(level), pyramid.height(level), {}};
    image.texels.assign(static_cast<std::size_t>(image.width * image.height),
                        fabric::Rgba{0, 0, 0, 0});
    for (std::int32_t y = 0; y < pyramid.tilesY(level); ++y)
        for (std::int32_t x = 0; x < pyramid.tilesX(level); ++x) {
            const terrain::TextureId id{level, x, y};
            if (!imagery.has(id))
                continue;
            const auto page = file.readTexture(id);
            EXPECT_TRUE(page.ok()) << page.status();
            std::vector<fabric::Rgba> texels((*page)->blocks().size() * 16);
            terrain::decodeBc1((*page)->blocks(), (*page)->blocksX(), texels);
            const terrain::TexelRect rect = pyramid.texels(id);
            const std::int64_t own = terrain::kTextureSide;
            for (std::int64_t v = y * own; v < std::min(image.height, (y + 1) * own); ++v)
                for (std::int64_t u = x * own; u < std::min(image.width, (x + 1) * own); ++u)
                    image.texels[static_cast<std::size_t>(v * image.width + u)] =
                        texels[static_cast<std::size_t>((v - rect.y) * rect.columns +
                                                        (u - rect.x))];
        }
    return image;
}

}  // namespace eyrie::test
