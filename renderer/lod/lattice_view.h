// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "renderer/lod/view.h"

namespace eyrie::lod {

/// What a vertex shader needs to place the integer lattice points of one data set.
///
/// The camera is snapped to the lattice. A vertex minus the snapped camera is a small integer and
/// so exact in float32; what is left of the camera, the lattice's spacing and the rotation live in
/// one matrix that all tiles and nodes share. The same lattice point therefore has the same bits
/// wherever it is drawn: no cracks between tiles, processes or machines.
struct LatticeView {
    /// `objectFromLattice` is affine, object units per lattice step and origin. What is large in
    /// the eye, the object's place and the lattice's origin cancels before anything is rounded to
    /// doubles (on x86; where `long double` has no more digits, while it is rounded).
    LatticeView(const View& view, const fabric::Mat4& worldFromObject,
                const fabric::Mat4& objectFromLattice);

    glm::ivec3 cameraLattice;         ///< each at most 2^23, so that differences stay below 2^24
    glm::mat4 clipFromLattice;        ///< of (lattice - cameraLattice); reversed infinite depth
    fabric::Mat3 metresFromLattice;   ///< of the same, along world axes
    fabric::Vec3 cameraOffsetMetres;  ///< from the snapped camera to the camera, along world axes
};

}  // namespace eyrie::lod
