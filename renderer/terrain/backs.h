// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/terrain/terrain_cut.h"

namespace eyrie::terrain {

/// Whether all backs of a cut are hidden by fronts: the eye is over a cell of a terrain without
/// holes, above all that is drawn there, and the near plane is, too. A line of sight then begins
/// above the surface, whose outline is convex seen from above; so it comes to a front before it
/// comes to a back. Docs/errors.md#backs-of-terrain. `drawn` covers the terrain, `view` sees it as
/// it is drawn.
bool hidesItsBacks(const EytIndex& index, const TerrainCut& drawn, const lod::ObjectView& view);

}  // namespace eyrie::terrain
