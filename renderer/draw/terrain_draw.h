// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/object_program.h"
#include "renderer/draw/terrain_paging.h"
#include "renderer/page/loader.h"

namespace eyrie::draw {

/// The shaders of terrain, with the uniforms that only terrain has.
class TerrainProgram {
public:
    static absl::StatusOr<TerrainProgram> create(Variant variant);

    ObjectProgram object;
    GLint tileOrigin;
    GLint spacingShift;
    GLint heightMultiplier;
    GLint lastPost;
    GLint lowestHeight;
    GLint bandsPerHeight;

private:
    explicit TerrainProgram(ObjectProgram linked);
};

/// Opens `object.path` as a .eyt file. `programs` and `loader` outlive what is returned. Errors:
/// NotFound, InvalidArgument, DataLoss, Unavailable, ResourceExhausted (the limits are too small).
absl::StatusOr<std::unique_ptr<Drawable>> openTerrain(const fabric::SceneObject& object,
                                                      Variants<TerrainProgram>& programs,
                                                      page::Loader& loader,
                                                      const TerrainMemory& limits);

}  // namespace eyrie::draw
