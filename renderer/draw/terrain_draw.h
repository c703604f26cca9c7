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
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

using TerrainPrograms = effects::EffectVariants<effects::TerrainEffect>;

/// What a terrain may take with all of it in memory, at most, besides its index.
MemoryUse greatestUse(const terrain::EytFile& file, TextureFormat format);

/// Draws `file` as `object`. `programs`, `loader` and `decoding` outlive what is returned. Errors:
/// those of TerrainPaging::open and of DecodeChoice::decoderFor.
absl::StatusOr<std::unique_ptr<Drawable>> openTerrain(const fabric::SceneObject& object,
                                                      std::shared_ptr<const terrain::EytFile> file,
                                                      TerrainPrograms& programs,
                                                      page::Loader& loader,
                                                      const TerrainMemory& limits,
                                                      TextureFormat format, DecodeChoice& decoding);

}  // namespace eyrie::draw
