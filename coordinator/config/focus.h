// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/destinations.h"

namespace eyrie::config {

/// The ratio by which an observer's focus moves the walls of a destination's view away from the
/// eyes: as the nearest of them asks. 1 where the focus is fixed, or nobody looks.
///
/// `destinations`: all that are shown. `roomFromHead`: the observer's.
double focusRatio(const Configuration& configuration, std::span<const Destination> destinations,
                  const Destination& destination, const fabric::Mat4& roomFromHead);

}  // namespace eyrie::config
