// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"

namespace eyrie::compound {

/// What is wrong with a configuration that resolves, and would be said of its frames only: plans
/// each canvas in each of its layouts, in each frame of its compounds' periods (the first
/// kMostFramesTried), as large as it is configured and as its equalizers share it out before they
/// have learned anything. Adds the errors with which there is no picture in any size, such as
/// frames that wait for each other, and warns of pictures that renderers draw smaller only, of
/// parts of pictures that nobody draws, and of a configuration without canvas.
void checkPlans(const config::Configuration& configuration, config::Findings& findings);
inline constexpr std::int64_t kMostFramesTried = 60;

}  // namespace eyrie::compound
