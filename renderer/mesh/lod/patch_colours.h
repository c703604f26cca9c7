// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "renderer/mesh/lod/patch.h"
#include "renderer/mesh/lod/tints.h"
#include "renderer/mesh/packed_mesh.h"

/// The colours of meshes' vertices, and their opacity, on patches: how far from where the source
/// has it a colour may be shown. docs/errors.md#vertex-colours.
namespace eyrie::mesh {

/// In a channel, as displayed, or in opacity, of 1: what is off by no more has no error. Half a
/// step of a byte is left for the rounding of points' colours.
inline constexpr float kColourTolerance = 8.0F / 255;
inline constexpr float kMostTint = kColourTolerance - 0.5F / 255;

/// Whether a triangle that shows `shown` shows a wrong colour somewhere.
inline bool isOff(const FieldChanges& tints, const FieldRange& shown) {
    return mostTint(tints, shown) > kMostTint;
}

/// Of the longest side of a triangle that shows `shown`: at any of its points a colour is shown
/// that is within kMostTint of those of its corners within this.
float reachShare(const FieldRange& shown);

std::array<FieldValue, 3> lightsOf(const PackedMesh& mesh, const Triangle& triangle);

/// Lattice steps.
double longestSide(const PackedMesh& mesh, const Triangle& triangle);

/// Whether the patch, and what it stands for, has no colour or but one.
bool hasOneColour(const PackedMesh& mesh, const Patch& patch);

/// One a triangle. Of a patch without any they are those of the source's triangles, of which it
/// then consists, or which have one colour.
std::vector<FieldChanges> tintsOf(const PackedMesh& mesh, const Patch& patch);

/// Lattice steps: at any point of the patch the colour shown is within kMostTint of that of the
/// point's partner, or of those that the source has at vertices within this. 0 where no triangle is
/// off.
double colourReach(const PackedMesh& mesh, const Patch& patch);

}  // namespace eyrie::mesh
