// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/star_colours.h"

#include <algorithm>

#include "renderer/mesh/lod/patch_colours.h"

namespace eyrie::mesh {
namespace {

double reachOf(const Star& star, std::size_t triangle, std::size_t target,
               const FieldRange& shown) {
    return double{reachShare(shown)} * star.longestSide(triangle, target);
}

}  // namespace

ColourAtCentre colourAtCentre(const StarField& colours, const Star& star, std::size_t target,
                              const Star::Landing& landing) {
    const std::size_t triangle = star.at(target, landing.triangle);
    const FieldRange shown = colours.shownBy(triangle, target);
    const FieldChanges tints =
        colours.all().andThen(colours.changeAtCentre(star, target, landing), shown);
    return {mostTint(tints, shown),
            isOff(tints, shown) ? reachOf(star, triangle, target, shown) : 0};
}

double colourReach(const StarField& colours, const Star& star, std::size_t target,
                   const Star::Landing& landing, const Star::Outcome& replaced) {
    double reach = 0;
    colours.forLeft(star, target, landing, replaced,
                    [&](std::size_t i, const FieldChanges& tints, const FieldRange& shown) {
                        if (isOff(tints, shown))
                            reach = std::max(reach, reachOf(star, i, target, shown));
                    });
    return reach;
}

}  // namespace eyrie::mesh
