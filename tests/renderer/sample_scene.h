// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "fabric/scene.h"

namespace eyrie::test {

enum class SampleKind { Mesh, Terrain, Both };

std::string name(SampleKind kind);

/// A synthetic mesh of about 60,000 triangles, a synthetic terrain of 1025² posts, or the mesh
/// standing on the terrain. Imported once a process, into a folder that goes with it.
absl::StatusOr<fabric::Scene> sampleScene(SampleKind kind);

}  // namespace eyrie::test
