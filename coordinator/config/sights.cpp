// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/sights.h"

#include <optional>
#include <string>

#include <fmt/format.h>

#include "coordinator/config/focus.h"

namespace eyrie::config {
namespace {

/// How far beside a compound's part of the wall the pixels lie that are drawn of it, of several
/// apart: in pixels of the destination.
fabric::Vec2 shiftOf(std::span<const fabric::Regridding> regriddings) {
    fabric::Vec2 shift{0, 0};
    fabric::Vec2 pixel{1, 1};
    for (const fabric::Regridding& each : regriddings)
        if (each.kind == fabric::Regridding::Kind::EveryNth) {
            const fabric::Vec2 every(each.everyColumn, each.everyRow);
            shift += pixel * (fabric::Vec2(each.firstColumn, each.firstRow) + .5 - every / 2.0);
            pixel *= every;
        } else {
            pixel *=
                fabric::Vec2(each.of.width, each.of.height) / fabric::Vec2(each.width, each.height);
        }
    return shift;
}

/// Whether its observer is where a tracker says, not where the file has it.
bool isTracked(const Configuration& configuration, const View& view) {
    if (!view.observer)
        return false;
    const Observer& observer = configuration.observers[*view.observer];
    return !observer.vrpnTracker.empty() ||
           (!observer.openCvCamera.empty() && observer.openCvCamera != "OFF");
}

/// Of its compound or, where none makes its picture, of its segment.
Place placeOf(const Configuration& configuration, const Destination& shown,
              const ResolvedCompound& compound) {
    return compound.compound != nullptr
               ? compound.place()
               : configuration.canvases[shown.index.canvas].segments[shown.index.segment].place;
}

}  // namespace

void addSights(const Configuration& configuration, std::span<const Destination> destinations,
               ResolvedCompound& compound, Findings& findings) {
    if (!compound.destination)
        return;
    const Destination& destination = destinations[*compound.destination];
    const std::optional<Wall>& wall = compound.wall ? compound.wall : destination.wall;
    if (!wall)
        return;
    const View& view =
        configuration.layouts[destination.index.layout].views[destination.index.view];
    const EyePlaces places = eyePlaces(configuration, view);
    const Wall inFocus =
        scaled(*wall, places.cyclop,
               focusRatio(configuration, destinations, destination, fabric::Mat4(1.0)));
    const fabric::Vec2 shift =
        shiftOf(compound.regriddings) /
        fabric::Vec2(destination.pixelViewport.width, destination.pixelViewport.height);
    const Viewport& share = compound.viewport;
    const Wall seen =
        part(inFocus, {share.x + shift.x, share.y + shift.y, share.width, share.height});
    using Eye = EyeSight::Eye;
    const auto add = [&](bool isShown, Eye eye, const char* name, const fabric::Vec3& place) {
        if (!isShown)
            return;
        compound.sights.push_back({eye, sightThrough(seen, place)});
        if (compound.sights.back().sight)
            return;
        const Place said = placeOf(configuration, destination, compound);
        const std::string blind =
            fmt::format("the eye {} is not before the wall that it looks through", name);
        if (isTracked(configuration, view))
            findings.warning(said, blind + ": it sees nothing until its head is moved there");
        else
            findings.error(said, blind +
                                     "; where the wall shows its back, exchange its bottom and "
                                     "top, or its left and right");
    };
    add(compound.eyes.cyclop, Eye::Cyclop, "CYCLOP", places.cyclop);
    add(compound.eyes.left, Eye::Left, "LEFT", places.left);
    add(compound.eyes.right, Eye::Right, "RIGHT", places.right);
}

}  // namespace eyrie::config
