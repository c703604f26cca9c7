// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "renderer/draw/mesh_cut.h"
#include "renderer/lod/view.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

/// About how much of the time of drawing all of `nodes`, a cut of `view`, each of them takes, times
/// anything above 0: what its triangles take, and more the more of it is seen. Boxes alone say what
/// is: a node counts as hidden where all of its box is farther than all of another's.
///
/// The same on every machine for the same file and view.
std::vector<double> workOf(const mesh::EymFile& file, const lod::ObjectView& view,
                           std::span<const CutNode> nodes);

}  // namespace eyrie::draw
