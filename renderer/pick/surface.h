// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>

#include <absl/status/statusor.h>

#include "fabric/vec.h"
#include "renderer/pick/ray.h"
#include "renderer/pick/recent_pages.h"

namespace eyrie::pick {

inline constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// The first point of a surface on a ray.
struct Hit {
    double t = kNowhere;
    fabric::Vec3 normal{0, 0, 1};  ///< world; any length, either side
    double errorMetres = 0;        ///< world; how far the source's surface may be from it
    std::optional<double> elevationMetres;
    double elevationErrorMetres = 0;  ///< object
};

/// What a ray meets of one object.
struct Cast {
    std::optional<Hit> hit;
    /// The ray does not meet the source before `nearest`, and has met it by `farthest`.
    double nearest = kNowhere;
    double farthest = kNowhere;
};

struct CastOptions {
    RecentPages& pages;          ///< where pages are looked for and left ...
    std::uint32_t object = 0;    ///< ... by this number
    double exaggeration = 1;     ///< of terrain
    double farthest = kNowhere;  ///< nothing beyond is of interest
    std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
};

/// An object's data at their finest. Immutable: any thread may ask.
class Surface {
public:
    virtual ~Surface() = default;

    /// Reads what of the object lies along a ray in world space whose t is the view's depth in
    /// metres, until it has met the source for certain. Errors: those of reading a page, naming
    /// it; DeadlineExceeded.
    virtual absl::StatusOr<Cast> cast(const Ray& ray, const CastOptions& options) const = 0;
};

/// DeadlineExceeded once the time is over.
absl::Status checkDeadline(const CastOptions& options);

}  // namespace eyrie::pick
