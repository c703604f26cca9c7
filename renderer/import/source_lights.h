// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fabric/scene.h"
#include "fabric/vec.h"
#include "renderer/import/triangle_mesh.h"

/// Lights as formats have them become those that a scene has (fabric/scene.h).
namespace eyrie::import {

/// What a source says of a light. At a distance d from one at a place, colour / (constant +
/// linear * d + quadratic * d^2) of it arrives.
struct SourceLight {
    enum class Kind { Distant, Point };
    Kind kind = Kind::Point;
    fabric::Vec3 place{0};   ///< metres or, of a distant one, the way that it shines
    fabric::Vec3 colour{1};  ///< linear, of any unit that is the same for all of a source
    double constant = 1;
    double linear = 0;
    double quadratic = 0;
    std::optional<fabric::LightCone> cone = {};  ///< of a spot
};

/// Pictures have no exposure: where a distant light is brighter than 1, all are darker by what
/// makes it 1. One at a place is nowhere brighter than 1, and far away as bright as the source says
/// (without `quadratic`, half as bright where the source has it so). Black lights are left out, and
/// those whose numbers make none, which a line of `notes` counts.
fabric::FileLights lightsFrom(std::span<const SourceLight> lights, std::vector<std::string>& notes);

/// Leaves at most fabric::kMaxLights lights, the brightest in the middle of the mesh, and says so
/// in its notes.
void limitLights(TriangleMesh& mesh);

}  // namespace eyrie::import
