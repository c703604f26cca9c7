// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <absl/status/status.h>

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"
#include "coordinator/config/state.h"

namespace eyrie::compound {

/// What is wrong with a configuration that resolves, and would be said of its frames only: plans
/// each canvas in each of its layouts, in each frame of its compounds' periods (the first
/// kMostFramesTried), as large as it is configured and as its equalizers share it out before they
/// have learned anything. Adds the errors with which there is no picture in any size, such as
/// frames that wait for each other, and warns of pictures that renderers draw smaller only, of
/// parts of pictures that nobody draws, of parts of the data that come without depth, of what
/// one eye alone sees in stereo, and of a configuration without canvas.
void checkPlans(const config::Configuration& configuration, config::Findings& findings);
inline constexpr std::int64_t kMostFramesTried = 60;
/// Compounds, each as often as it is planned: beyond that a note says how much was not tried.
inline constexpr std::int64_t kMostCompoundsTried = 500'000;

/// Whether the equalizer, of those from 0 on, may be as `state` has it: one that divides data, and
/// does not as it is written, only where all that have a part of the data send depths.
/// InvalidArgument: who does not.
absl::Status checkDivision(const config::Configuration& written,
                           const config::ConfigurationState& state, std::size_t equalizer);

}  // namespace eyrie::compound
