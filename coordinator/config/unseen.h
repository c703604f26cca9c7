// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns of destinations whose compounds make nothing of what their views show, such as those of
/// LEFT and RIGHT eyes of a view that is MONO.
void warnOfUnseen(const ResolvedConfiguration& resolved, Findings& findings);

}  // namespace eyrie::config
