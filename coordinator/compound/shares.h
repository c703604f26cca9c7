// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"

namespace eyrie::compound {

/// Adds an error for each number of a configuration that cannot be computed with, of those that may
/// change while it runs, naming the compound, frame, view or segment and the value: not finite, a
/// rectangle or range out of [0, 1], a share of none or of itself, a zoom out of (0, 64].
void checkShares(const config::Configuration& configuration, config::Findings& findings);

}  // namespace eyrie::compound
