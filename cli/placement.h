// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::cli {

/// Whether the two boxes have a point of the ground plan in common.
bool overlapsInPlan(const fabric::Box& a, const fabric::Box& b);

/// Height of the terrain at (x, y), object space, at full resolution; the bounds' lowest where
/// there is no data. Errors: those of EytFile::readPage.
absl::StatusOr<double> groundHeightMetres(const terrain::EytFile& terrain, double x, double y);

/// World from a mesh's object space so that it stands at the middle of the terrain, its lowest
/// point on the ground, its longest side a quarter of the terrain's.
absl::StatusOr<fabric::Mat4> placeOnTerrain(const fabric::Box& mesh,
                                            const terrain::EytFile& terrain);

}  // namespace eyrie::cli
