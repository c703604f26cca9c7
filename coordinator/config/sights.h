// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Gives `compound` its sights: of each of its eyes, through its part of its wall (else of its
/// destination's), heads where the file has them and the wall as their observer's focus moves it.
/// None where it is in no destination's picture or nothing has a wall.
///
/// `destinations`: all that are shown. An eye that is not before the wall is an error, of a tracked
/// observer a warning.
void addSights(const Configuration& configuration, std::span<const Destination> destinations,
               ResolvedCompound& compound, Findings& findings);

}  // namespace eyrie::config
