// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "fabric/vec.h"
#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

/// One source, and where a scene has it.
struct PlacedSurface {
    std::shared_ptr<const ReferenceSurface> surface;  ///< in its own space; may stand in several
    fabric::Mat4 worldFromObject{1.0};                ///< affine, not singular
};

/// Several sources in one world: the nearest is seen. A drawn point is held against each source's
/// counterpart in that source's own space, and the least displacement counts, unless its source is
/// known: that the point belongs to another does not show in it, but in its depth
/// (DepthComparison::misplaced). A point over a terrain's nodata has no counterpart there.
class PlacedSurfaces final : public ReferenceSurface {
public:
    /// Precondition: there is one.
    explicit PlacedSurfaces(const std::vector<PlacedSurface>& surfaces);

    HitRange hitRange(const Ray& ray) const override;
    HitRange throughSeams(const Ray& ray, double reach) const override;
    bool endsWithin(const fabric::Vec3& point, double reach,
                    const std::function<bool(const fabric::Vec3&)>& isThere) const override;
    bool isBesideEndOfOne(const fabric::Vec3& point, double reach,
                          const std::function<bool(const fabric::Vec3&)>& isThere) const override;
    /// In world space the closest of the sources' counterparts.
    std::optional<fabric::Vec3> counterpart(const fabric::Vec3& point) const override;
    Displacement displacement(const Pinhole& camera, const fabric::Vec3& point) const override;
    /// `source`: its place among those given.
    Displacement displacementFrom(std::size_t source, const Pinhole& camera,
                                  const fabric::Vec3& point) const override;

private:
    struct Placed {
        std::shared_ptr<const ReferenceSurface> surface;
        bool isWhereItIs = true;  ///< the transform is none
        fabric::Mat4 worldFromObject{1.0};
        fabric::Mat4 objectFromWorld{1.0};
    };

    /// Of what `cast` says of each, given its surface and the ray in its space.
    template <typename Cast>
    HitRange nearest(const Ray& ray, const Cast& cast) const;
    static bool endsWithin(const Placed& placed, const fabric::Vec3& point, double reach,
                           const std::function<bool(const fabric::Vec3&)>& isThere);
    static Displacement displacement(const Placed& placed, const Pinhole& camera,
                                     const fabric::Vec3& point);

    std::vector<Placed> placed_;
};

}  // namespace eyrie::truth
