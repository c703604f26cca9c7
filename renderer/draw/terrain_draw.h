// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "effects/terrain_effect.h"
#include "fabric/scene.h"
#include "renderer/draw/decode_choice.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/terrain_paging.h"
#include "renderer/effects/effect_variants.h"
#include "renderer/page/loader.h"
#include "renderer/page/page_source.h"

namespace eyrie::draw {

using TerrainPrograms = effects::EffectVariants<effects::TerrainEffect>;

/// Opens `object.path` as a .eyt file. `programs`, `loader` and `decoding` outlive what is
/// returned. Errors: those of EytFile::open; ResourceExhausted (the limits are too small); those of
/// DecodeChoice::decoderFor.
absl::StatusOr<std::unique_ptr<Drawable>> openTerrain(const fabric::SceneObject& object,
                                                      TerrainPrograms& programs,
                                                      const page::SourceOptions& sources,
                                                      page::Loader& loader,
                                                      const TerrainMemory& limits,
                                                      TextureFormat format, DecodeChoice& decoding);

}  // namespace eyrie::draw
