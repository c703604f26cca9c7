// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "renderer/effects/language/effect_model.h"

namespace eyrie::effects {

/// The header of a checked effect: `class TerrainEffect` of terrain.effect, which owns a program
/// and has a setter for each uniform, a constant for each input and pass, and the GLSL. It derives
/// from the class of each block that it includes.
std::string effectHeader(const Effect& effect);

/// The header of a checked block: `class ObjectBlock` of object.block, the uniforms, parameters and
/// passes that effects share.
std::string blockHeader(const EffectFile& block);

}  // namespace eyrie::effects
