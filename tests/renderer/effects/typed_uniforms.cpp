// SPDX-License-Identifier: Apache-2.0
// Compiled by tests, one USE of an effect at a time: CMakeLists.txt says which must fail, and how.
#include "effects/mesh_effect.h"
#include "effects/terrain_effect.h"

#ifndef USE
#define USE terrain.ambient(1.0F)
#endif

using namespace eyrie;

void use([[maybe_unused]] const effects::TerrainEffect& terrain,
         [[maybe_unused]] const effects::MeshEffect& mesh,
         [[maybe_unused]] const gl::Texture2D& texture) {
    USE;
}
