// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "renderer/import/terrain_import.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::test {

/// A folder of its own that goes with the object.
class TemporaryFolder {
public:
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    /// Names of all files in it.
    std::vector<std::string> files() const;

private:
    std::filesystem::path folder_;
};

/// What an elevation model on disk is read as, whole.
struct Dem {
    terrain::HeightGrid grid;
    std::string crsWkt;
    std::uint64_t sourceHash = 0;
    std::vector<std::string> notes;
    std::vector<std::string> findings;
};
absl::StatusOr<Dem> readDem(const std::string& path);
absl::StatusOr<Dem> readDems(const std::vector<std::string>& paths);

/// All bytes of a file.
std::string contents(const std::string& path);

/// Writes `grid` as an .eyt in `folder` and opens it. Fails the test, and returns null, on errors.
std::shared_ptr<const terrain::EytFile> imported(const terrain::HeightGrid& grid,
                                                 const TemporaryFolder& folder,
                                                 const import::TerrainImportOptions& options = {});

/// A corner as it is drawn: a post and its height step, decoded from the file.
struct DrawnCorner {
    std::int32_t i = 0;
    std::int32_t j = 0;
    std::int32_t q = 0;

    auto operator<=>(const DrawnCorner&) const = default;
};
using DrawnTriangle = std::array<DrawnCorner, 3>;

/// The triangles of one part of a tile, decoded as TileGeometry says.
std::vector<DrawnTriangle> drawnPart(const terrain::EytFile& file,
                                     const terrain::TileGeometry& tile, const terrain::TileId& id,
                                     int part);

/// The triangles of a tile whose neighbours beyond `finerEdges` are one level finer.
std::vector<DrawnTriangle> drawnTile(const terrain::EytFile& file, const terrain::TileId& id,
                                     std::uint8_t finerEdges);

/// The same triangle for measuring, heights in metres.
terrain::Triangle inMetres(const terrain::EytFile& file, const DrawnTriangle& triangle);

/// Twice the area in posts; positive when counter-clockwise.
std::int64_t doubleArea(const DrawnTriangle& triangle);

}  // namespace eyrie::test
