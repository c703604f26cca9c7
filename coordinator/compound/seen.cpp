// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/seen.h"

#include "coordinator/config/destinations.h"
#include "coordinator/config/focus.h"
#include "coordinator/config/pixels.h"
#include "fabric/status.h"

namespace eyrie::compound {
namespace {

using fabric::Mat4;
using fabric::Vec3;
using fabric::Vec4;

const config::View& viewOf(const config::Configuration& configuration,
                           const config::Destination& destination) {
    return configuration.layouts[destination.index.layout].views[destination.index.view];
}

const config::Observer* observerOf(const config::Configuration& configuration,
                                   const config::View& view) {
    return view.observer ? &configuration.observers[*view.observer] : nullptr;
}

Mat4 headOf(const config::View& view, const config::Display& display) {
    return view.observer && *view.observer < display.heads.size() ? display.heads[*view.observer]
                                                                  : Mat4(1.0);
}

Vec3 moved(const Mat4& roomFromHead, const Vec3& point) {
    return Vec3(roomFromHead * Vec4(point, 1));
}

const Vec3& placeOf(Eye eye, const config::EyePlaces& places) {
    switch (eye) {
        case Eye::Left:
            return places.left;
        case Eye::Right:
            return places.right;
        case Eye::Cyclop:
            break;
    }
    return places.cyclop;
}

absl::StatusOr<std::optional<fabric::Sight>> through(const config::Wall& wall, const Vec3& eye) {
    const auto sight = config::sightThrough(wall, eye);
    if (!sight)
        return absl::FailedPreconditionError(
            "the eye is not before the wall that it is to look through");
    RETURN_IF_ERROR(fabric::withContext(fabric::validate(*sight),
                                        "the eye sees what cannot be drawn through its wall"));
    return sight;
}

/// Straight ahead at the focus, as large as the camera's field of view is there.
config::Wall wallAhead(double distance, double fovYDegrees, const fabric::PixelViewport& view) {
    const double aspect = static_cast<double>(view.width) / view.height;
    const fabric::Frustum at = fabric::symmetricFrustum(fovYDegrees, aspect);
    const auto corner = [&](double x, double y) {
        return Vec3(x * distance, y * distance, -distance);
    };
    return {corner(at.left, at.bottom), corner(at.right, at.bottom), corner(at.left, at.top),
            false};
}

}  // namespace

Surroundings surroundingsOf(const config::Destination& destination,
                            const std::optional<config::Wall>& wall) {
    const config::Panorama& panorama = destination.panorama;
    const fabric::PixelViewport whole{0, 0, panorama.width, panorama.height};
    if (!wall)
        return {whole, panorama.wall};
    const fabric::PixelViewport& own = destination.partOfPanorama;
    return {whole, config::part(config::widened(*wall, destination.widening),
                                config::fractionOf(whole, own))};
}

double focusRatio(const config::Configuration& configuration, const config::Display& display,
                  const config::ResolvedConfiguration& resolved,
                  const config::Destination& destination) {
    return config::focusRatio(configuration, resolved.destinations, destination,
                              headOf(viewOf(configuration, destination), display));
}

absl::StatusOr<std::optional<fabric::Sight>> seen(const config::Configuration& configuration,
                                                  const PlanRequest& request,
                                                  const config::Destination& destination,
                                                  const Surroundings& surroundings, Eye eye,
                                                  double focusRatio) {
    const config::View& view = viewOf(configuration, destination);
    const config::EyePlaces places = config::eyePlaces(configuration, view);
    const double unit = request.display.modelUnit(destination.index.layout, destination.index.view);
    if (!surroundings.wall) {
        if (eye == Eye::Cyclop)
            return std::nullopt;
        const config::Observer* const observer = observerOf(configuration, view);
        const double focus = observer != nullptr ? observer->focusDistance : 1;
        const config::Wall wall = wallAhead(focus * unit, request.fovYDegrees, surroundings.whole);
        return through(wall, unit * (placeOf(eye, places) - places.cyclop));
    }
    const Mat4 head = headOf(view, request.display);
    const bool isWorn = surroundings.wall->movesWithHead;
    // What is worn is where the head is; a room's walls are seen from where the eyes are.
    const Mat4 ofWall = isWorn ? head : Mat4(1.0);
    const auto cyclop = isWorn ? places.cyclop : moved(head, places.cyclop);
    config::Wall wall = config::scaled(*surroundings.wall, cyclop, focusRatio);
    wall = config::scaled(config::moved(wall, ofWall), Vec3(0, 0, 0), unit);
    return through(wall, unit * moved(head, placeOf(eye, places)));
}

}  // namespace eyrie::compound
