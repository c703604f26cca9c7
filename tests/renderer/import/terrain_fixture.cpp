// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/import/terrain_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "renderer/import/dem_source.h"
#include "renderer/import/height_source.h"

namespace eyrie::test {

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "eyrie-test-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
        ADD_FAILURE() << "no temporary folder at " << pattern;
    folder_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

std::vector<std::string> TemporaryFolder::files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        names.push_back(entry.path().filename().string());
    return names;
}

absl::StatusOr<Dem> readDem(const std::string& path) { return readDems({path}); }

absl::StatusOr<Dem> readDems(const std::vector<std::string>& paths) {
    auto source = import::openDems(paths, {});
    if (!source.ok())
        return source.status();
    const terrain::GridFrame& frame = source->posts->frame();
    Dem dem;
    dem.grid.columns = frame.columns;
    dem.grid.rows = frame.rows;
    dem.grid.origin = frame.origin;
    dem.grid.perColumn = frame.perColumn;
    dem.grid.perRow = frame.perRow;
    dem.crsWkt = source->crsWkt;
    dem.sourceHash = source->hash;
    dem.notes = source->notes;
    dem.grid.heights.resize(static_cast<std::size_t>(frame.columns) *
                            static_cast<std::size_t>(frame.rows));
    const absl::Status read =
        source->posts->read({0, 0, frame.columns, frame.rows}, dem.grid.heights.data());
    if (!read.ok())
        return read;
    dem.findings = source->posts->findings();
    source->posts->release();
    EXPECT_EQ(source->posts->findings(), dem.findings);
    return dem;
}

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::shared_ptr<const terrain::EytFile> imported(const terrain::HeightGrid& grid,
                                                 const TemporaryFolder& folder,
                                                 const import::TerrainImportOptions& options) {
    const std::string path = folder.path("terrain.eyt");
    import::GridHeightSource posts(grid);
    const auto report = import::importTerrain(posts, {"grid", "", 0}, path, options, {});
    EXPECT_TRUE(report.ok()) << report.status();
    if (!report.ok())
        return nullptr;
    auto file = terrain::EytFile::open(path);
    EXPECT_TRUE(file.ok()) << file.status();
    return file.ok() ? *file : nullptr;
}

std::vector<DrawnTriangle> drawnPart(const terrain::EytFile& file,
                                     const terrain::TileGeometry& tile, const terrain::TileId& id,
                                     int part) {
    const terrain::Quadtree& quadtree = file.index().quadtree;
    const auto corner = [&](std::uint16_t vertex) {
        const std::uint32_t* word =
            &tile.words[vertex * static_cast<std::size_t>(tile.wordsPerVertex)];
        const std::uint32_t second = tile.wordsPerVertex == 2 ? word[1] : 0;
        const auto post = [&](std::int32_t first, std::uint32_t half, std::int32_t posts) {
            const auto offset =
                static_cast<std::int32_t>(half << terrain::Quadtree::spacingShift(id.level)) / 2;
            return std::min(first * terrain::Quadtree::side(id.level) + offset, posts - 1);
        };
        return DrawnCorner{post(id.x, word[0] & 1023, quadtree.columns()),
                           post(id.y, word[0] >> 10 & 1023, quadtree.rows()),
                           tile.baseHeight + static_cast<std::int32_t>((word[0] >> 20) + second) *
                                                 tile.heightMultiplier};
    };
    std::vector<DrawnTriangle> triangles;
    const terrain::IndexRange range = tile.parts[static_cast<std::size_t>(part)];
    for (std::uint32_t k = range.first; k < range.first + range.count; k += 3)
        triangles.push_back(
            {corner(tile.indices[k]), corner(tile.indices[k + 1]), corner(tile.indices[k + 2])});
    return triangles;
}

std::vector<DrawnTriangle> drawnTile(const terrain::EytFile& file, const terrain::TileId& id,
                                     std::uint8_t finerEdges) {
    const auto page = file.readPage(file.index().quadtree.pageIndex(id));
    EXPECT_TRUE(page.ok()) << page.status();
    if (!page.ok())
        return {};
    const terrain::TileGeometry& tile = (*page)->tile(terrain::Quadtree::placeInPage(id));
    std::vector<DrawnTriangle> triangles = drawnPart(file, tile, id, terrain::kInteriorPart);
    for (int edge = 0; edge < terrain::kEdges; ++edge) {
        const int form = (finerEdges >> edge & 1) != 0 ? terrain::kFinerPart : terrain::kOwnPart;
        const auto part = drawnPart(file, tile, id, form + edge);
        triangles.insert(triangles.end(), part.begin(), part.end());
    }
    return triangles;
}

terrain::Triangle inMetres(const terrain::EytFile& file, const DrawnTriangle& triangle) {
    terrain::Triangle result;
    for (std::size_t k = 0; k < 3; ++k)
        result[k] = {
            triangle[k].i, triangle[k].j,
            file.index().heightOriginMetres() + file.index().heightStepMetres() * triangle[k].q};
    return result;
}

std::int64_t doubleArea(const DrawnTriangle& t) {
    return std::int64_t{t[1].i - t[0].i} * (t[2].j - t[0].j) -
           std::int64_t{t[2].i - t[0].i} * (t[1].j - t[0].j);
}

}  // namespace eyrie::test
