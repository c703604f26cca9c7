// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns of eyes that views show and their compounds do not make, such as the RIGHT one where all
/// have LEFT alone. What makes some may leave the others to segments that lie over it or, of
/// displays on a head, which show an eye each, to any other.
void warnOfUnseen(const Configuration& configuration, const ResolvedConfiguration& resolved,
                  Findings& findings);

}  // namespace eyrie::config
