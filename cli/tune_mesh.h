// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/bench/flights.h"
#include "renderer/import/mesh_import.h"

namespace eyrie::cli {

/// Leaf sizes that are tried, in triangles; none beyond the first that holds all of a mesh.
inline constexpr std::array<std::uint32_t, 4> kTriedLeafTriangles = {4096, 8192, 16384, 32768};

/// What a flight at tau 1 over a mesh of one leaf size took.
struct TriedLeaf {
    std::uint32_t leafTriangles = 0;
    double medianMs = 0;  ///< of a frame, in the fastest of the rounds
    double trianglesMean = 0;
    double promisedPixels = 0;  ///< of the worst frame
    std::string limitingStage;  ///< fabric::limitingStage
    import::MeshImportReport report;
};

struct MeshTuning {
    std::vector<TriedLeaf> tried;  ///< ascending
    std::size_t best = 0;
};

/// The one of the least median; of those within 3 %, which the next run may order otherwise, that
/// of the smallest file. Precondition: not empty.
std::size_t bestOf(const std::vector<TriedLeaf>& tried);

/// Imports with so many triangles a leaf into a file of that path.
using ImportLeaf = std::function<absl::StatusOr<import::MeshImportReport>(
    std::uint32_t leafTriangles, const std::string& path)>;

/// Imports a mesh with each leaf size, plays `flight` over each, three times
/// in turn, on this machine's first device, and keeps the best at `outPath`, where the choice is
/// kept in the file (mesh::EymFile::tunedLeafTriangles). What was tried lies beside it meanwhile.
/// `done` is told the stage and its share. Errors, all with nothing left behind: those of
/// `importLeaf`, PictureSource and bench::NamedFlight::over; Cancelled.
absl::StatusOr<MeshTuning> tuneMesh(const std::string& outPath, const bench::NamedFlight& flight,
                                    const ImportLeaf& importLeaf,
                                    const std::function<void(std::string_view, double)>& done,
                                    const std::stop_token& stop);

/// A line for each, the best one marked.
std::string table(const MeshTuning& tuning);

}  // namespace eyrie::cli
