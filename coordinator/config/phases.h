// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns where compounds that draw a destination in turn leave frames out: what it shows then is
/// background. Of the first kMostFramesLookedAt frames.
void warnOfMissingPhases(const ResolvedConfiguration& resolved, Findings& findings);
inline constexpr std::int64_t kMostFramesLookedAt = 1024;

}  // namespace eyrie::config
