// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/ray.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/frustum.h"

namespace eyrie::pick {

using fabric::Vec3;

Ray rayThrough(const fabric::PickRequest& request) {
    const double width = request.viewWidth;
    const double height = request.viewHeight;
    const fabric::Frustum frustum =
        fabric::symmetricFrustum(request.camera.fovYDegrees, width / height);
    const Vec3 inView(frustum.right * (2 * request.place.x / width - 1),
                      frustum.top * (2 * request.place.y / height - 1), -1);
    const fabric::Mat3 rotation = fabric::viewFromWorldRotation(request.camera);
    return {request.camera.eye, glm::transpose(rotation) * inView};
}

/// Translations may be thousands of kilometres: they are taken off first, not multiplied.
Ray inFrame(const Ray& ray, const fabric::Mat4& worldFromFrame) {
    const fabric::Mat3 linear = glm::inverse(fabric::Mat3(worldFromFrame));
    return {linear * (ray.origin - Vec3(worldFromFrame[3])), linear * ray.direction};
}

Span clip(Span span, const Ray& ray, const Vec3& normal, double limit) {
    const double at0 = glm::dot(normal, ray.origin) - limit;
    const double slope = glm::dot(normal, ray.direction);
    if (slope > 0)
        span.end = std::min(span.end, -at0 / slope);
    else if (slope < 0)
        span.begin = std::max(span.begin, -at0 / slope);
    else if (at0 > 0)
        span.end = span.begin - 1;
    return span;
}

Span clip(Span span, const Ray& ray, const fabric::Box& box) {
    for (int k = 0; k < 3; ++k) {
        const double o = ray.origin[k];
        const double d = ray.direction[k];
        if (d == 0) {
            if (o < box.min[k] || o > box.max[k])
                return {0, -1};
            continue;
        }
        double in = (box.min[k] - o) / d;
        double out = (box.max[k] - o) / d;
        if (d < 0)
            std::swap(in, out);
        span = {std::max(span.begin, in), std::min(span.end, out)};
    }
    return span;
}

}  // namespace eyrie::pick
