// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "fabric/scene.h"
#include "renderer/pick/surface.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::pick {

/// The tiles of an .eyt's finest level, as they are drawn side by side.
std::unique_ptr<const Surface> terrainSurface(const fabric::SceneObject& object,
                                              std::shared_ptr<const terrain::EytFile> file);

}  // namespace eyrie::pick
