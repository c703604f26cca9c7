// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "effects/mesh_effect.h"
#include "fabric/scene.h"
#include "renderer/draw/device_texture.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/mesh_points.h"
#include "renderer/effects/effect_variants.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/page/loader.h"

namespace eyrie::draw {

using MeshPrograms = effects::EffectVariants<effects::MeshEffect>;

/// What a mesh may take with all of it in memory, at most.
MemoryUse greatestUse(const mesh::EymFile& file, TextureFormat format);

/// Draws `file` as `object`. Textures may take half of its memory on the device. Both kinds of
/// programs and `loader` outlive what is returned. Errors: those of MeshPaging::open and
/// MeshTextures::read; ResourceExhausted (textures).
absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   std::shared_ptr<const mesh::EymFile> file,
                                                   MeshPrograms& programs,
                                                   PointPrograms& pointPrograms,
                                                   page::Loader& loader, const MeshMemory& memory,
                                                   TextureFormat format);

}  // namespace eyrie::draw
