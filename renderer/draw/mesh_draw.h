// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/object_program.h"

namespace eyrie::draw {

/// The shaders of meshes.
struct MeshProgram {
    static absl::StatusOr<MeshProgram> create(Variant variant);

    ObjectProgram object;
};

/// Opens `object.path` as a .eym file. `programs` outlives what is returned. Errors: NotFound,
/// InvalidArgument, DataLoss.
absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   Variants<MeshProgram>& programs,
                                                   std::uint64_t memoryBytes);

}  // namespace eyrie::draw
