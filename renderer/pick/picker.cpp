// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/picker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fabric/status.h"
#include "renderer/pick/mesh_surface.h"
#include "renderer/pick/terrain_surface.h"

namespace eyrie::pick {
namespace {

using fabric::Vec3;

absl::StatusOr<std::unique_ptr<const Surface>> openSurface(const fabric::SceneObject& object,
                                                           const page::SourceOptions& sources) {
    if (object.kind == fabric::ObjectKind::Terrain) {
        ASSIGN_OR_RETURN(auto file, terrain::EytFile::open(object.path, sources));
        return terrainSurface(object, std::move(file));
    }
    ASSIGN_OR_RETURN(mesh::EymFile file, mesh::EymFile::open(object.path, sources));
    return meshSurface(object, std::make_shared<const mesh::EymFile>(std::move(file)));
}

double largest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// What the arithmetic on world coordinates adds.
double roundingMetres(const Vec3& eye, const Vec3& point) {
    return 16 * std::numeric_limits<double>::epsilon() * (largest(eye) + largest(point));
}

fabric::PickedPoint pointOf(const fabric::PickRequest& request, const Ray& ray, std::size_t object,
                            const Hit& hit, const Span& source) {
    fabric::PickedPoint point;
    point.object = static_cast<std::int32_t>(object);
    point.worldMetres = ray.at(hit.t);
    const double rounding = roundingMetres(ray.origin, point.worldMetres);
    const double metresPerT = glm::length(ray.direction);
    const Vec3 normal = glm::normalize(hit.normal);
    point.normal = glm::dot(normal, ray.direction) > 0 ? -normal : normal;
    point.distanceMetres = hit.t * metresPerT;
    point.errorMetres = hit.errorMetres + rounding;
    point.nearestMetres = std::min(source.begin, hit.t) * metresPerT - rounding;
    point.farthestMetres = std::max(source.end, hit.t) * metresPerT + rounding;
    const fabric::Frustum frustum = frustumOf(request);
    point.pixelMetres = hit.t * (frustum.top - frustum.bottom) / request.viewHeight;
    point.elevationMetres = hit.elevationMetres;
    point.elevationErrorMetres = hit.elevationErrorMetres;
    return point;
}

}  // namespace

absl::Status checkDeadline(const CastOptions& options) {
    if (std::chrono::steady_clock::now() > options.deadline)
        return absl::DeadlineExceededError(
            "the data along the line of sight could not be read in time; try again");
    return absl::OkStatus();
}

Picker::Picker(std::vector<std::unique_ptr<const Surface>> surfaces)
    : surfaces_(std::move(surfaces)), pages_(kRecentBytes) {}

absl::StatusOr<std::shared_ptr<const Picker>> Picker::open(const fabric::Scene& scene,
                                                           const page::SourceOptions& sources) {
    RETURN_IF_ERROR(fabric::validate(scene));
    std::vector<std::unique_ptr<const Surface>> surfaces;
    for (const fabric::SceneObject& object : scene.objects) {
        ASSIGN_OR_RETURN(auto surface, openSurface(object, sources));
        surfaces.push_back(std::move(surface));
    }
    return std::make_shared<const Picker>(std::move(surfaces));
}

absl::StatusOr<fabric::Picked> Picker::pick(const fabric::PickRequest& request,
                                            Clock::time_point deadline) const {
    RETURN_IF_ERROR(fabric::validate(request));
    const Ray ray = rayThrough(request);
    CastOptions options{pages_, 0, request.exaggeration, kNowhere, deadline};
    Hit first;
    std::size_t object = 0;
    double nearest = kNowhere;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        if (request.hidden.contains(i))
            continue;
        options.object = static_cast<std::uint32_t>(i);
        ASSIGN_OR_RETURN(const Cast cast, surfaces_[i]->cast(ray, options));
        nearest = std::min(nearest, cast.nearest);
        options.farthest = std::min(options.farthest, cast.farthest);
        if (cast.hit && cast.hit->t < first.t) {
            first = *cast.hit;
            object = i;
        }
    }
    if (first.t == kNowhere)
        return fabric::Picked();
    return fabric::Picked(pointOf(request, ray, object, first, {nearest, options.farthest}));
}

}  // namespace eyrie::pick
