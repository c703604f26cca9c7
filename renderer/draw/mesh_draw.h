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
#include "renderer/page/page_source.h"

namespace eyrie::draw {

using MeshPrograms = effects::EffectVariants<effects::MeshEffect>;

/// Opens `object.path` as a .eym file. Textures may take half of its memory on the device.
/// Both kinds of programs and `loader` outlive what is returned. Errors: those of EymFile::open and
/// of MeshPaging::open.
absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   MeshPrograms& programs,
                                                   PointPrograms& pointPrograms,
                                                   const page::SourceOptions& sources,
                                                   page::Loader& loader, const MeshMemory& memory,
                                                   TextureFormat format);

}  // namespace eyrie::draw
