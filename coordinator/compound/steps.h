// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/compound/work.h"

namespace eyrie::compound {

/// Works as steps on framebuffers: what comes over what, in which order, and by depth or not.
///
/// Of pictures that meet, that of the lower range wins where depths are equal, whichever arrives
/// first. Adds framebuffers for the samples of subpixel compounds to `list`. InvalidArgument where
/// a frame cannot be brought into the pixels of who takes it.
absl::StatusOr<std::vector<Step>> stepsOf(const config::ResolvedConfiguration& resolved,
                                          const std::vector<Work>& works, WorkList& list);

}  // namespace eyrie::compound
