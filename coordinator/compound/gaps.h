// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/compound/contents.h"
#include "coordinator/compound/work.h"

namespace eyrie::compound {

/// Warns of destinations of which some compounds draw something and nobody draws some part of the
/// picture, of its pixels or of the data: it stays background; or of which nothing that is drawn
/// gets there. `contents`: of the list's framebuffers, in the end. Not of destinations that nothing
/// is drawn of, or whose eye is not before the wall; nor of samples (subpixel). Warns of walls
/// through which an eye sees what renderers cannot draw, too.
void warnOfGaps(const config::ResolvedConfiguration& resolved, const WorkList& list,
                std::span<const Picture> pictures, std::span<const Contents> contents,
                config::Findings& findings);

}  // namespace eyrie::compound
