// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Notes canvases of which several segments take the same place for the same eyes, as walls of a
/// room do that all take the whole of it: in one picture of the canvas only the last is seen.
void noteOverlaps(const Configuration& configuration, const ResolvedConfiguration& resolved,
                  Findings& findings);

}  // namespace eyrie::config
