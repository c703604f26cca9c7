// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "renderer/draw/mesh_cut.h"
#include "renderer/lod/view.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

/// What a triangle takes whose pixels are seen, where one takes 1 that is not: on llvmpipe, of
/// scans at tau 1 (docs/benchmarks/farm.md).
inline constexpr double kWorkOfSeen = 5;

/// About how long drawing each of `nodes`, a cut of `view`, takes: 1 a triangle, and up to
/// kWorkOfSeen the more of the node is seen. Boxes alone say what is: a node counts as hidden where
/// all of its box is farther than all of another's.
///
/// The same on every machine for the same file and view.
std::vector<double> workOf(const mesh::EymFile& file, const lod::ObjectView& view,
                           std::span<const CutNode> nodes);

}  // namespace eyrie::draw
