// SPDX-License-Identifier: Apache-2.0
#include "renderer/lod/channel.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace eyrie::lod {
namespace {

/// Cosine of the angle between two directions of one viewer, from frame to frame.
constexpr double kNearlyTheSameWay = 0.8;
/// The same of two walls: a wall does not turn, only the room does.
constexpr double kTheSameWall = 0.9999;

double length(const fabric::Range& range) { return range.end - range.begin; }

bool areMostlyTheSame(const fabric::Range& a, const fabric::Range& b) {
    const fabric::Range both{std::max(a.begin, b.begin), std::min(a.end, b.end)};
    return 2 * length(both) >= std::max(length(a), length(b));
}

bool areMostlyTheSame(const fabric::PixelViewport& a, const fabric::PixelViewport& b) {
    return 2 * intersection(a, b).area() >= std::max(a.area(), b.area());
}

double area(const fabric::Frustum& f) { return (f.right - f.left) * (f.top - f.bottom); }

/// Two tiles of a wall have the same axis and size.
bool areMostlyTheSame(const fabric::Frustum& a, const fabric::Frustum& b) {
    const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double height = std::min(a.top, b.top) - std::max(a.bottom, b.bottom);
    return 2 * std::max(width, 0.0) * std::max(height, 0.0) >= std::max(area(a), area(b));
}

/// Along the view's axis.
fabric::Vec3 direction(const View& view) { return -glm::transpose(view.viewFromWorldRotation)[2]; }

/// The same in the camera's axes.
fabric::Vec3 directionOfWall(const View& view) {
    return view.cameraFromWorldRotation * direction(view);
}

}  // namespace

bool mayContinue(const Channel& last, const Channel& next) {
    return last.view.width == next.view.width && last.view.height == next.view.height &&
           areMostlyTheSame(last.range, next.range) && areMostlyTheSame(last.part, next.part) &&
           areMostlyTheSame(last.view.frustum, next.view.frustum) &&
           glm::dot(direction(last.view), direction(next.view)) > kNearlyTheSameWay &&
           glm::dot(directionOfWall(last.view), directionOfWall(next.view)) > kTheSameWall;
}

}  // namespace eyrie::lod
