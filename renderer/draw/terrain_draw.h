// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "effects/terrain_effect.h"
#include "fabric/scene.h"
#include "renderer/draw/drawable.h"
#include "renderer/effects/effect_variants.h"

namespace eyrie::draw {

using TerrainPrograms = effects::EffectVariants<effects::TerrainEffect>;

/// Opens `object.path` as a .eyt file. `programs` outlives what is returned. Errors: NotFound,
/// InvalidArgument, DataLoss.
absl::StatusOr<std::unique_ptr<Drawable>> openTerrain(const fabric::SceneObject& object,
                                                      TerrainPrograms& programs,
                                                      std::uint64_t memoryBytes);

}  // namespace eyrie::draw
