// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/ray.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace eyrie::pick {

using fabric::Vec3;

fabric::Frustum frustumOf(const fabric::PickRequest& request) {
    if (request.sight)
        return request.sight->frustum;
    return fabric::symmetricFrustum(request.camera.fovYDegrees,
                                    static_cast<double>(request.viewWidth) / request.viewHeight);
}

Ray rayThrough(const fabric::PickRequest& request) {
    const fabric::Frustum frustum = frustumOf(request);
    const double x = request.place.x / request.viewWidth;
    const double y = request.place.y / request.viewHeight;
    // Weighted ends, so that the middle of a frustum straight ahead is straight ahead to the bit.
    const Vec3 inView((1 - x) * frustum.left + x * frustum.right,
                      (1 - y) * frustum.bottom + y * frustum.top, -1);
    const fabric::Mat3 worldFromCamera =
        glm::transpose(fabric::viewFromWorldRotation(request.camera));
    if (!request.sight)
        return {request.camera.eye, worldFromCamera * inView};
    return {request.camera.eye + worldFromCamera * request.sight->eye,
            worldFromCamera * (glm::transpose(request.sight->viewFromCamera) * inView)};
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
