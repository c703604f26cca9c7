// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "effects/object_block.h"
#include "fabric/vec.h"
#include "renderer/draw/drawable.h"

namespace eyrie::draw {

/// The variant that draws an object in a frame. Software renderers pay in every pixel for a light
/// the scene does not have, a branch not taken and a rotation that the lights could have been given
/// once.
effects::ObjectBlock::Variant variantFor(const FrameState& frame,
                                         const fabric::Mat4& worldFromObject);

/// Sets the uniforms that every kind of object has, for one whose vertices lie on a lattice.
void setObject(const effects::ObjectBlock& program, const FrameState& frame,
               const fabric::Mat4& worldFromObject, const fabric::Mat4& objectFromLattice);

}  // namespace eyrie::draw
