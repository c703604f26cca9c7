// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

#include "coordinator/config/configuration.h"

namespace eyrie::compound {

/// Whether the numbers of a configuration that may change while it runs can be computed with.
/// InvalidArgument, naming the compound, view or segment and the value: not finite, a rectangle or
/// range out of [0, 1], a share of none or of itself, a zoom out of (0, 64].
absl::Status checkShares(const config::Configuration& configuration);

}  // namespace eyrie::compound
