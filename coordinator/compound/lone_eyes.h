// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::compound {

/// Warns of segments that show one eye's picture of a view in stereo where none, on any canvas,
/// shows the other's: as of two halves of a canvas of which each has another eye.
void warnOfLoneEyes(const config::Configuration& configuration,
                    const config::ResolvedConfiguration& resolved, config::Findings& findings);

}  // namespace eyrie::compound
