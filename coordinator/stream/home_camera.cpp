// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/home_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "fabric/look.h"

namespace eyrie::stream {
namespace {

constexpr double kAspect = 4.0 / 3.0;
constexpr double kMargin = 1.06;

/// From the target to the eye.
fabric::Vec3 viewingDirection(const fabric::Vec3& size) {
    const bool isFlat = size.z < std::max(size.x, size.y) / 3;
    const double elevation = glm::radians(isFlat ? 30.0 : 20.0);
    const double southWest = -std::sqrt(0.5) * std::cos(elevation);
    return {southWest, southWest, std::sin(elevation)};
}

/// Along one axis of the picture: where the eye stands and how far back, so that everything just
/// fits. A point at `across` and `towards` the eye is seen by an eye at `shift` and `distance` if
/// |across - shift| <= tangent * (distance - towards): two half-planes a point.
struct Fit {
    struct Point {
        double across;
        double towards;
    };
    std::vector<Point> points;
    double tangent = 1;

    /// The least.
    double distance() const {
        double low = -std::numeric_limits<double>::infinity();
        double high = std::numeric_limits<double>::infinity();
        for (const Point& p : points) {
            low = std::max(low, p.across + tangent * p.towards);
            high = std::min(high, p.across - tangent * p.towards);
        }
        return (low - high) / (2 * tangent);
    }

    /// From so far away, with as much left free on the one side as on the other: seen by the
    /// smallest tangent that does.
    double shift(double distance) const {
        double least = 0;
        for (const Point& p : points)
            for (const Point& q : points)
                least =
                    std::max(least, (p.across - q.across) / (2 * distance - p.towards - q.towards));
        double shift = -std::numeric_limits<double>::infinity();
        for (const Point& p : points)
            shift = std::max(shift, p.across - least * (distance - p.towards));
        return shift;
    }
};

}  // namespace

fabric::Camera homeCamera(const fabric::Box& bounds) {
    fabric::Camera camera;
    const fabric::Vec3 centre = bounds.centre();
    const fabric::Vec3 back = viewingDirection(bounds.size());
    camera.target = centre;
    camera.eye = centre + back;
    const fabric::Mat3 viewFromWorld = fabric::viewFromWorldRotation(camera);
    Fit vertical;
    vertical.tangent = std::tan(glm::radians(camera.fovYDegrees / 2));
    Fit horizontal;
    horizontal.tangent = vertical.tangent * kAspect;
    for (int i = 0; i < 8; ++i) {
        const fabric::Vec3 corner = viewFromWorld * (bounds.corner(i) - centre);
        vertical.points.push_back({corner.y, corner.z});
        horizontal.points.push_back({corner.x, corner.z});
    }
    // A scene of a single point still needs an eye beside it, and a direction of view that the
    // coordinates' rounding, of some 1e-16, leaves alone.
    const double smallest = 1e-9 * std::max(1.0, glm::length(centre));
    const double distance =
        std::max(kMargin * std::max(vertical.distance(), horizontal.distance()), smallest);
    const fabric::Vec3 eyeFromCentre{horizontal.shift(distance), vertical.shift(distance),
                                     distance};
    camera.eye = centre + glm::transpose(viewFromWorld) * eyeFromCentre;
    // What is orbited about lies at the height of the scene's middle.
    camera.target = camera.eye - back * ((camera.eye.z - centre.z) / back.z);
    return camera;
}

fabric::Box exaggeratedBounds(const fabric::SceneInfo& scene, double exaggeration) {
    if (exaggeration == 1 || !scene.ground)
        return scene.bounds;
    std::vector<fabric::Box> boxes;
    for (const fabric::ObjectInfo& object : scene.objects) boxes.push_back(object.bounds);
    for (const fabric::GroundGrid& grid : *scene.ground) {
        const auto object = static_cast<std::size_t>(grid.object);
        if (object >= boxes.size())
            return scene.bounds;
        boxes[object] = fabric::transformed(
            fabric::transformed(boxes[object], glm::inverse(grid.worldFromGrid)),
            fabric::exaggerated(grid.worldFromGrid, exaggeration));
    }
    fabric::Box all;
    for (const fabric::Box& box : boxes) all.grow(box);
    return all;
}

}  // namespace eyrie::stream
