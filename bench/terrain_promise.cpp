// SPDX-License-Identifier: Apache-2.0
// What terrain promises of its error beside what there is, over seeded cameras.
//
//   build/release/bench/terrain_promise [--cameras N=200] [--tau PIXELS=1] [--csv FILE] DEM...
//
// N cameras in total, the same for each number of files: overview, mid, close and grazing in turn,
// 640 x 360 (docs/benchmarks.md). A DEM is anything `eyrie import terrain` reads, or synth:POSTS.
// The judge is a double-precision ray cast of the posts as the importer reads them.
#include "renderer/truth/terrain_promise.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/dem_source.h"
#include "renderer/import/geotiff_writer.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/truth/terrain_cameras.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace eyrie;
using truth::TerrainCameras;

constexpr std::uint32_t kSeed = 20261121;
constexpr int kWidth = 640;
constexpr int kHeight = 360;
/// Promises below that are too near to what rasterisation itself rounds off for a ratio.
constexpr double kLeastPixels = 1.0 / 16;

struct Options {
    std::vector<std::string> dems;
    int cameras = 200;
    double tauPixels = 1;
    std::string csv;
};

struct Row {
    std::string dem;
    TerrainCameras::Kind kind;
    truth::PromiseKept kept;

    bool hasRatio() const {
        return kept.promisedPixels >= kLeastPixels && kept.measuredPixels > 0 &&
               std::isfinite(kept.promisedPixels);
    }
    double ratio() const { return kept.promisedPixels / kept.measuredPixels; }
};

absl::StatusOr<truth::HeightGrid> readPosts(const std::string& path) {
    ASSIGN_OR_RETURN(import::DemSource source, import::openDems({path}, {}));
    const terrain::GridFrame& frame = source.posts->frame();
    truth::HeightGrid grid{.columns = frame.columns,
                           .rows = frame.rows,
                           .heights = {},
                           .origin = frame.origin,
                           .perColumn = frame.perColumn,
                           .perRow = frame.perRow};
    grid.heights.resize(static_cast<std::size_t>(frame.columns) *
                        static_cast<std::size_t>(frame.rows));
    RETURN_IF_ERROR(source.posts->read({0, 0, frame.columns, frame.rows}, grid.heights.data()));
    return grid;
}

absl::Status hold(const std::string& dem, int cameras, const Options& options,
                  const test::TemporaryFolder& folder, std::vector<Row>& rows) {
    std::string path = dem;
    if (dem.starts_with("synth:")) {
        path = folder.path("synthetic.tif");
        RETURN_IF_ERROR(import::writeGeoTiff(
            import::synthesizeTerrain(static_cast<std::uint32_t>(std::atoi(dem.c_str() + 6)), 7),
            path));
    }
    const std::string out = folder.path("terrain.eyt");
    RETURN_IF_ERROR(import::importTerrain({path}, out, {}, {}).status());
    ASSIGN_OR_RETURN(truth::HeightGrid posts, readPosts(path));
    const truth::TerrainRayCaster ground(std::move(posts));
    ASSIGN_OR_RETURN(const auto file, terrain::EytFile::open(out));
    ASSIGN_OR_RETURN(const auto renderer, Renderer::create({}));
    fabric::Scene scene;
    scene.objects.push_back({.name = dem, .kind = fabric::ObjectKind::Terrain, .path = out});
    ASSIGN_OR_RETURN(const fabric::SceneInfo info, renderer->openScene(scene));
    const truth::TerrainPromise promise(*renderer, ground, file);
    TerrainCameras make(ground, info.bounds, kSeed);
    for (int i = 0; i < cameras; ++i) {
        const auto kind = static_cast<TerrainCameras::Kind>(i % TerrainCameras::kKinds);
        ASSIGN_OR_RETURN(truth::PromiseKept kept,
                         promise.hold(make.make(kind), options.tauPixels, kWidth, kHeight));
        rows.push_back({dem.substr(dem.rfind('/') + 1), kind, kept});
    }
    return absl::OkStatus();
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double quantile(std::vector<double> values, double q) {
    if (values.empty())
        return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void printGroup(const std::string& name, const std::vector<Row>& rows) {
    std::vector<double> ratios, promised, measured, atPixels, triangles;
    double worst = 0;
    std::size_t broken = 0, holes = 0, falseHits = 0, misplaced = 0, suspects = 0;
    for (const Row& row : rows) {
        const truth::DepthComparison& found = row.kept.measured;
        broken +=
            row.kept.measuredPixels > row.kept.promisedPixels + truth::TerrainPromise::kRasterPixels
                ? 1
                : 0;
        if (row.hasRatio()) {
            ratios.push_back(row.ratio());
            promised.push_back(row.kept.promisedPixels);
            measured.push_back(row.kept.measuredPixels);
            atPixels.push_back(found.maxPixels);
            worst = std::max(worst, row.kept.measuredPixels / row.kept.promisedPixels);
        }
        triangles.push_back(static_cast<double>(row.kept.statistics.triangles));
        holes += found.holes;
        falseHits += found.falseHits;
        misplaced += found.misplaced;
        suspects += found.suspects;
    }
    fmt::print(
        "{:<28} {:>4} {:>4}  {:7.3f} {:7.3f} {:7.3f}  {:6.3f} {:6.3f} {:6.3f} {:6.3f} {:6.3f}  "
        "{:6.3f} {:>4} {:>4} "
        "{:>4} {:>5} {:>4} {:>8.0f}\n",
        name, rows.size(), ratios.size(), mean(promised), mean(measured), mean(atPixels),
        mean(promised) / mean(measured), mean(ratios), quantile(ratios, 0.1), quantile(ratios, 0.5),
        quantile(ratios, 0.9), worst, broken, holes, falseHits, misplaced, suspects,
        mean(triangles));
}

void printTable(const std::vector<Row>& rows) {
    fmt::print(
        "{:<28} {:>4} {:>4}  {:>7} {:>7} {:>7}  {:>6} {:>6} {:>6} {:>6} {:>6}  {:>6} {:>4} {:>4} "
        "{:>4} "
        "{:>5} {:>4} {:>8}\n",
        "", "all", "used", "promise", "measure", "pixels", "means", "ratio", "p10", "p50", "p90",
        "worst", "over", "hole", "fals", "mispl", "susp", "triang");
    const auto where = [&](auto condition) {
        std::vector<Row> some;
        std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), condition);
        return some;
    };
    std::vector<std::string> dems;
    for (const Row& row : rows)
        if (dems.empty() || dems.back() != row.dem)
            dems.push_back(row.dem);
    for (const std::string& dem : dems)
        printGroup(dem, where([&](const Row& row) { return row.dem == dem; }));
    for (int kind = 0; kind < TerrainCameras::kKinds; ++kind)
        printGroup(std::string(TerrainCameras::kNames[static_cast<std::size_t>(kind)]),
                   where([&](const Row& row) { return static_cast<int>(row.kind) == kind; }));
    printGroup("all", rows);
}

void writeCsv(const std::string& path, const std::vector<Row>& rows) {
    std::ofstream file(path);
    file << "dem,camera,promised_px,measured_px,surface_px,at_pixels_px,p99_px,compared,holes,"
            "false,misplaced,"
            "suspects,"
            "triangles\n";
    for (const Row& row : rows) {
        const truth::DepthComparison& found = row.kept.measured;
        file << fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.dem,
                            TerrainCameras::kNames[static_cast<std::size_t>(row.kind)],
                            row.kept.promisedPixels, row.kept.measuredPixels,
                            row.kept.surfacePixels, found.maxPixels, found.p99Pixels,
                            found.compared, found.holes, found.falseHits, found.misplaced,
                            found.suspects, row.kept.statistics.triangles);
    }
}

absl::Status run(const Options& options) {
    std::vector<Row> rows;
    const auto files = static_cast<int>(options.dems.size());
    for (int i = 0; i < files; ++i) {
        const test::TemporaryFolder folder;
        const int cameras = options.cameras * (i + 1) / files - options.cameras * i / files;
        RETURN_IF_ERROR(
            hold(options.dems[static_cast<std::size_t>(i)], cameras, options, folder, rows));
    }
    printTable(rows);
    if (!options.csv.empty())
        writeCsv(options.csv, rows);
    return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        const bool hasValue = i + 1 < argc;
        if (argument == "--cameras" && hasValue)
            options.cameras = std::max(1, std::atoi(argv[++i]));
        else if (argument == "--tau" && hasValue)
            options.tauPixels = std::atof(argv[++i]);
        else if (argument == "--csv" && hasValue)
            options.csv = argv[++i];
        else
            options.dems.emplace_back(argument);
    }
    if (options.dems.empty() || options.dems.front().starts_with("--")) {
        fmt::print(stderr,
                   "usage: terrain_promise [--cameras N=200] [--tau PIXELS=1] [--csv FILE] "
                   "DEM|synth:POSTS...\n");
        return 2;
    }
    if (const absl::Status status = run(options); !status.ok()) {
        fmt::print(stderr, "{}\n", status.ToString());
        return 1;
    }
    return 0;
}
