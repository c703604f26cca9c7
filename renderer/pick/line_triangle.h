// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "renderer/pick/ray.h"

namespace eyrie::pick {

/// Tells which triangles a ray meets. Points are given from the ray's origin on. A ray through an
/// edge or a point that triangles share meets one of them at least: what decides is computed from
/// the edge alone, and is the same for both but for its sign.
/// S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", 2013; in double precision
/// there is nothing to fall back to where an edge function is 0: both triangles are met then.
class RayFrame {
public:
    explicit RayFrame(const fabric::Vec3& direction);

    /// A point seen along the ray: x and y across it, in a plane that is not quite square to it,
    /// and z the ray's parameter where it passes that plane.
    fabric::Vec3 seen(const fabric::Vec3& fromOrigin) const;

    /// How far from (0, 0) a point within `metres` of the ray is seen at most.
    double reach(double metres) const { return metres * stretch_; }

private:
    int kx_;
    int ky_;
    int kz_;
    double sx_;
    double sy_;
    double perDepth_;
    double stretch_;
};

using SeenTriangle = std::array<fabric::Vec3, 3>;

/// Whether some of a triangle may be within `reach` of the ray.
bool mayPass(const SeenTriangle& triangle, double reach);

/// The ray's parameter where it meets the triangle; nothing for one seen edge-on.
std::optional<double> meets(const SeenTriangle& triangle);

/// A triangle and the ray, both from the ray's origin.
struct Passage {
    std::array<fabric::Vec3, 3> corners;
    fabric::Vec3 direction;

    fabric::Vec3 normal() const;  ///< of any length
};

/// Holds the parameters of all points of the ray within `metres` of the triangle; empty where
/// there are none, and in some cases where there are none, too, not empty.
Span within(const Passage& passage, double metres, Span span);

/// Whether the ray meets every triangle whose corners lie within `metres` of this one's, given that
/// it meets this one: it passes the edges at a greater distance.
bool meetsAllNear(const Passage& passage, double metres);

}  // namespace eyrie::pick
