// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/lighting.h"
#include "renderer/gl/program.h"

namespace eyrie::draw {

/// The shaders of terrain, made once a context. Outlives the drawables that use it.
class TerrainProgram {
public:
    static absl::StatusOr<TerrainProgram> create();

    gl::Program program;
    LightingUniforms lighting;
    GLint clipFromLattice;
    GLint metresFromLattice;
    GLint worldFromNormal;
    GLint cameraLattice;
    GLint tileOrigin;
    GLint spacingShift;
    GLint heightMultiplier;
    GLint lastPost;
    GLint heightStepMetres;
    GLint heightOriginMetres;
    GLint heightRangeMetres;
    GLint flatShading;

private:
    explicit TerrainProgram(gl::Program linked);
};

/// Opens `object.path` as a .eyt file. Errors: NotFound, InvalidArgument, DataLoss.
absl::StatusOr<std::unique_ptr<Drawable>> openTerrain(const fabric::SceneObject& object,
                                                      const TerrainProgram& program,
                                                      std::uint64_t memoryBytes);

}  // namespace eyrie::draw
