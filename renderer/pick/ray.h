// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/box.h"
#include "fabric/frustum.h"
#include "fabric/pick.h"
#include "fabric/vec.h"

namespace eyrie::pick {

/// A half-line; a point on it is origin + t * direction, t > 0.
struct Ray {
    fabric::Vec3 origin;
    fabric::Vec3 direction;

    fabric::Vec3 at(double t) const { return origin + t * direction; }
};

/// Parameters of a piece of a ray; empty when begin > end.
struct Span {
    double begin = 0;
    double end = 0;

    bool isEmpty() const { return !(begin <= end); }
};

/// What the picture asked for spans at unit distance, by its sight or the camera's field of view.
fabric::Frustum frustumOf(const fabric::PickRequest& request);

/// In world space, through the place asked for; t is the depth along the view's axis, metres.
/// Precondition: fabric::validate(request) is ok.
Ray rayThrough(const fabric::PickRequest& request);

/// The same ray, with the same t, in another frame. Precondition: an affine map with an inverse.
Ray inFrame(const Ray& ray, const fabric::Mat4& worldFromFrame);

/// The part of `span` for which normal . point is at most `limit`, of points on the ray.
Span clip(Span span, const Ray& ray, const fabric::Vec3& normal, double limit);

/// The part inside a box.
Span clip(Span span, const Ray& ray, const fabric::Box& box);

}  // namespace eyrie::pick
