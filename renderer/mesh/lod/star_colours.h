// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "renderer/mesh/lod/star_field.h"

/// Colours on the triangles of a star (StarField, of light), and what moving its vertex onto a
/// neighbour costs them.
namespace eyrie::mesh {

/// What the triangle in which the centre lands does to the colour there, in a channel as displayed,
/// of 1; and how far colours come to it if that is too much.
struct ColourAtCentre {
    float tint = 0;
    double reach = 0;
};
ColourAtCentre colourAtCentre(const StarField& colours, const Star& star, std::size_t target,
                              const Star::Landing& landing);

/// How far colours come to any triangle that is left. `replaced`: what star.moveTo() says.
double colourReach(const StarField& colours, const Star& star, std::size_t target,
                   const Star::Landing& landing, const Star::Outcome& replaced);

}  // namespace eyrie::mesh
