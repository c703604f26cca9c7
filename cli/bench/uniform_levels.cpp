// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/uniform_levels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "renderer/truth/depth_comparison.h"
#include "renderer/truth/uniform_decimation.h"

namespace eyrie::cli::bench {
namespace {

constexpr std::size_t kFewestTriangles = 32;
constexpr int kMostLevels = 24;

/// A regular grid as it is drawn: one triangle on each side of the main diagonal.
class DrawnGrid final : public truth::ReferenceSurface {
public:
    explicit DrawnGrid(std::shared_ptr<const truth::TerrainRayCaster> caster)
        : caster_(std::move(caster)) {}

    HitRange hitRange(const truth::Ray& ray) const override {
        const double hit =
            caster_->firstHits(ray)[static_cast<std::size_t>(truth::CellSurface::MainDiagonal)];
        return {hit, hit};
    }
    std::optional<fabric::Vec3> counterpart(const fabric::Vec3& point) const override {
        return caster_->counterpart(point);
    }
    const truth::HeightGrid& grid() const { return caster_->grid(); }

private:
    std::shared_ptr<const truth::TerrainRayCaster> caster_;
};

struct Decimated {
    std::shared_ptr<const truth::ReferenceSurface> surface;  ///< null: nothing is left
    std::size_t triangles = 0;
    std::function<std::size_t(const fabric::Mat4&, const truth::Pinhole&)> inView;  ///< of these
};

/// At a half no post is left out: the source itself.
Decimated decimated(const std::shared_ptr<const truth::TerrainRayCaster>& terrain, double share) {
    const int stride = static_cast<int>(std::lround(std::sqrt(1 / share)));
    const truth::HeightGrid& grid = terrain->grid();
    if ((std::min(grid.columns, grid.rows) - 1) / stride < 1)
        return {};
    const auto caster =
        stride == 1
            ? terrain
            : std::make_shared<const truth::TerrainRayCaster>(truth::everyPost(grid, stride));
    const std::size_t triangles = truth::trianglesOf(caster->grid());
    if (triangles == 0)
        return {};
    const auto drawn = std::make_shared<DrawnGrid>(caster);
    return {drawn, triangles, [drawn](const fabric::Mat4& placed, const truth::Pinhole& camera) {
                return truth::trianglesInView(drawn->grid(), placed, camera);
            }};
}

Decimated decimated(const truth::MeshRayCaster& mesh, double share) {
    const double wanted = share * static_cast<double>(mesh.mesh().triangles.size());
    truth::TriangleMesh coarse = truth::clustered(mesh.mesh(), static_cast<std::size_t>(wanted));
    const std::size_t triangles = coarse.triangles.size();
    if (triangles == 0)
        return {};
    const auto drawn = std::make_shared<truth::MeshRayCaster>(std::move(coarse));
    return {drawn, triangles, [drawn](const fabric::Mat4& placed, const truth::Pinhole& camera) {
                return truth::trianglesInView(drawn->mesh(), placed, camera);
            }};
}

struct Level {
    std::vector<truth::PlacedSurface> surfaces;
    std::size_t triangles = 0;
    std::vector<std::function<std::size_t(const truth::Pinhole&)>> inView;  ///< of each surface

    std::size_t trianglesInView(const truth::Pinhole& camera) const {
        std::size_t seen = 0;
        for (const auto& ofSurface : inView) seen += ofSurface(camera);
        return seen;
    }
};

/// Sources that several objects show are decimated once, and count for each.
Level levelOf(const ReferenceScene& reference, double share) {
    std::map<const truth::ReferenceSurface*, Decimated> known;
    Level level;
    for (const ReferenceScene::Object& object : reference.objects) {
        const auto [place, isNew] = known.try_emplace(object.source.surface().get());
        if (isNew)
            place->second = object.source.terrain ? decimated(object.source.terrain, share)
                                                  : decimated(*object.source.mesh, share);
        if (!place->second.surface)
            continue;
        level.surfaces.push_back({place->second.surface, object.worldFromObject});
        level.triangles += place->second.triangles;
        level.inView.emplace_back([inView = place->second.inView,
                                   placed = object.worldFromObject](const truth::Pinhole& camera) {
            return inView(placed, camera);
        });
    }
    return level;
}

/// Displacements of one picture, in its own pixels.
std::vector<double> displacementsOf(const ReferenceScene& reference,
                                    const truth::PlacedSurfaces& level,
                                    const truth::Pinhole& camera) {
    std::vector<float> depth;
    for (const auto& hit : truth::castView(camera, level).hits)
        depth.push_back(static_cast<float>(hit.first));
    std::vector<double> pixels = truth::displacements(camera, depth, *reference.surface);
    std::erase_if(pixels, [](double value) { return std::isnan(value); });
    return pixels;
}

UniformLevel measured(const ReferenceScene& reference, const Level& level,
                      std::span<const fabric::Camera> cameras, int width, int height) {
    const truth::PlacedSurfaces surfaces(level.surfaces);
    const int smallHeight = std::min(kUniformHeight, height);
    const double scale = static_cast<double>(height) / smallHeight;
    const int smallWidth = std::max(1, static_cast<int>(std::lround(width / scale)));
    UniformLevel result{.trianglesWhole = static_cast<double>(level.triangles)};
    for (const fabric::Camera& camera : cameras) {
        const truth::Pinhole small(camera, smallWidth, smallHeight);
        result.triangles +=
            static_cast<double>(level.trianglesInView(small)) / static_cast<double>(cameras.size());
        std::vector<double> pixels = displacementsOf(reference, surfaces, small);
        if (pixels.empty())
            continue;
        result.p99Pixels = std::max(result.p99Pixels, scale * truth::percentile(pixels, 99));
        result.maxPixels = std::max(result.maxPixels, scale * *std::ranges::max_element(pixels));
    }
    return result;
}

}  // namespace

absl::StatusOr<std::vector<UniformLevel>> uniformLevels(const ReferenceScene& reference,
                                                        std::span<const fabric::Camera> cameras,
                                                        int width, int height, double untilPixels,
                                                        const std::function<void()>& levelDone,
                                                        const std::stop_token& stop) {
    /// Float depth moves points by a little, which is no error of a level.
    constexpr double kNoError = 1e-3;
    std::vector<UniformLevel> levels;
    for (int halvings = 1; halvings <= kMostLevels; ++halvings) {
        if (stop.stop_requested())
            return absl::CancelledError("stopped; nothing was written");
        const Level level = levelOf(reference, std::ldexp(1.0, -halvings));
        if (level.triangles < kFewestTriangles)
            break;
        const UniformLevel one = measured(reference, level, cameras, width, height);
        levelDone();
        if (one.p99Pixels > kNoError)
            levels.push_back(one);
        if (one.p99Pixels > untilPixels)
            break;
    }
    return levels;
}

}  // namespace eyrie::cli::bench
