// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "renderer/lod/view.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/truth/triangle.h"

namespace eyrie::truth {

/// The triangles of which a complete picture of one mesh is made, in world space and double
/// precision: the cut of `view` at `tauPixels`, from the file. Errors: those of reading pages.
absl::StatusOr<std::vector<Triangle>> drawnTriangles(const mesh::EymFile& file,
                                                     const lod::View& view, double tauPixels,
                                                     const fabric::Mat4& worldFromObject);

}  // namespace eyrie::truth
