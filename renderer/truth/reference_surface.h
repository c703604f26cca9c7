// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>

#include "renderer/truth/pinhole.h"

namespace eyrie::truth {

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();

/// How far a drawn point is, on the screen, from where the source has it.
struct Displacement {
    double pixels = std::nan("");  ///< NaN without a counterpart
    bool isInColumn = false;       ///< the counterpart is right above or below
    bool isBelow = false;          ///< the point lies below it
};

/// A full-resolution source that a picture is compared with. Immutable: any thread may ask.
class ReferenceSurface {
public:
    virtual ~ReferenceSurface() = default;

    /// Parameters between which a ray first hits the source; kNoHit where it may hit nothing.
    struct HitRange {
        double first = kNoHit;
        double last = kNoHit;
    };

    /// Where a ray first hits: a range where the source allows several surfaces (TerrainRayCaster).
    virtual HitRange hitRange(const Ray& ray) const = 0;

    /// The same where seams may open: beside an edge from which no triangle goes on to the other
    /// side, the next surface may be parted from it by the rounding of corners on the screen.
    /// Looked through are triangles with such an edge, or a corner of one, no farther from the ray
    /// than `reach` times its parameter there.
    virtual HitRange throughSeams(const Ray& ray, double /*reach*/) const { return hitRange(ray); }

    /// Whether the source ends, at nodata, a hole or its rim, at a point that `isThere` takes:
    /// those within `reach` metres of `point`, of terrain across the ground, are asked about, seen
    /// or not.
    virtual bool endsWithin(const fabric::Vec3& /*point*/, double /*reach*/,
                            const std::function<bool(const fabric::Vec3&)>& /*isThere*/) const {
        return false;
    }

    /// Of several sources, whether one has no counterpart of `point` and ends beside it, as
    /// endsWithin says: displacement() holds the point against the others, and it may have been
    /// made of this one.
    virtual bool isBesideEndOfOne(
        const fabric::Vec3& /*point*/, double /*reach*/,
        const std::function<bool(const fabric::Vec3&)>& /*isThere*/) const {
        return false;
    }

    /// The point of the source to hold `point` against: for terrain the one in the same column, for
    /// meshes the closest. Nothing where there is none.
    virtual std::optional<fabric::Vec3> counterpart(const fabric::Vec3& point) const = 0;

    /// Of `point` from its counterpart, seen by `camera`.
    virtual Displacement displacement(const Pinhole& camera, const fabric::Vec3& point) const;

    /// The same of a point that was made of one of several sources, from that one.
    virtual Displacement displacementFrom(std::size_t /*source*/, const Pinhole& camera,
                                          const fabric::Vec3& point) const {
        return displacement(camera, point);
    }
};

}  // namespace eyrie::truth
