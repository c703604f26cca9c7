// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/focus.h"

#include <limits>

#include <glm/geometric.hpp>

#include "coordinator/config/screen.h"

namespace eyrie::config {

using fabric::Mat4;
using fabric::Vec3;
using fabric::Vec4;

double focusRatio(const Configuration& configuration, std::span<const Destination> destinations,
                  const Destination& destination, const Mat4& roomFromHead) {
    const DestinationIndex& index = destination.index;
    const View& view = configuration.layouts[index.layout].views[index.view];
    if (!view.observer)
        return 1;
    const Observer& observer = configuration.observers[*view.observer];
    if (observer.focusMode == FocusMode::Fixed)
        return 1;
    const bool fromObserver = observer.focusMode == FocusMode::RelativeToObserver;
    double nearest = std::numeric_limits<double>::infinity();
    double ratio = 1;
    for (const Destination& other : destinations) {
        const bool isOfView = other.index.canvas == index.canvas &&
                              other.index.layout == index.layout && other.index.view == index.view;
        if (!isOfView || !other.panorama.wall)
            continue;
        // What is worn is where the head is, whose own coordinates it is in.
        const Mat4 head = other.panorama.wall->movesWithHead ? Mat4(1.0) : roomFromHead;
        const Vec3 eye(head * Vec4(eyePlaces(configuration, view).cyclop, 1));
        const Vec3 from = fromObserver ? eye : Vec3(0, 0, 0);
        const Vec3 ahead =
            fromObserver ? glm::normalize(Vec3(head * Vec4(0, 0, -1, 0))) : Vec3(0, 0, -1);
        const double distance = distanceAlong(*other.panorama.wall, from, ahead);
        // Along the same direction, how far the eye is; it stays where it is while the wall moves.
        const double ofEye = distanceAlong(*other.panorama.wall, eye, ahead);
        if (!(distance > 0 && distance < nearest && ofEye > 0))
            continue;
        nearest = distance;
        ratio = (observer.focusDistance - distance + ofEye) / ofEye;
    }
    return ratio > 0 ? ratio : 1;
}

}  // namespace eyrie::config
