// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/lighting.h"
#include "renderer/gl/program.h"

namespace eyrie::draw {

/// The shaders of meshes, made once a context. Outlives the drawables that use it.
class MeshProgram {
public:
    static absl::StatusOr<MeshProgram> create();

    gl::Program program;
    LightingUniforms lighting;
    GLint clipFromLattice;
    GLint metresFromLattice;
    GLint worldFromNormal;
    GLint cameraLattice;
    GLint cameraOffsetMetres;
    GLint flatShading;

private:
    explicit MeshProgram(gl::Program linked);
};

/// Opens `object.path` as a .eym file. Errors: NotFound, InvalidArgument, DataLoss.
absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   const MeshProgram& program,
                                                   std::uint64_t memoryBytes);

}  // namespace eyrie::draw
