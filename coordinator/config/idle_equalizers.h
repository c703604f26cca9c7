// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns of equalizers of a tree that do nothing where they stand, and of settings of theirs that
/// have no effect, or leave nothing to share out: of parts of pictures in mode DB and of data in
/// others, and boundaries as large as the whole. Settings at their usual values count as not
/// written.
void warnOfIdleEqualizers(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
