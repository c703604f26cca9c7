// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "fabric/scene.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/pick/surface.h"

namespace eyrie::pick {

/// The leaves of an .eym: its source's triangles, with the source's own positions where the file
/// has them. What is see-through is met like anything else, its holes, too. Backs are met unless
/// pictures leave them out: of one-sided materials, and of single-sided objects from an eye
/// outside.
std::unique_ptr<const Surface> meshSurface(const fabric::SceneObject& object,
                                           std::shared_ptr<const mesh::EymFile> file);

}  // namespace eyrie::pick
