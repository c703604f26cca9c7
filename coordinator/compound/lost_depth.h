// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "coordinator/compound/contents.h"
#include "coordinator/compound/work.h"

namespace eyrie::compound {

/// Of the frames that somebody takes those that have only a part of the data somewhere, and no
/// depth. `contents`: of the list's frames, as they are read back.
std::vector<LostDepth> lostDepth(const config::ResolvedConfiguration& resolved,
                                 const WorkList& list, std::span<const Contents> contents);

}  // namespace eyrie::compound
