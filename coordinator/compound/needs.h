// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/compound/plan.h"

namespace eyrie::compound {

/// Leaves of a plan's steps only what its pictures need, and of each only the part of it that they
/// need: from the pictures backwards, as a compiler finds dead code. Draws are asked for depth
/// where that is compared or wanted; those that nobody needs are gone, the others numbered anew.
void keepWhatIsNeeded(Plan& plan);

}  // namespace eyrie::compound
