// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "coordinator/compound/equalizer/equalizers.h"

namespace eyrie::equalizer {

/// `settings` with what `tuning` changes of them. Errors: InvalidArgument, naming the setting, what
/// it was to be and what it may be: the limits of configuration files.
absl::StatusOr<config::Equalizer> tuned(config::Equalizer settings, const Tuning& tuning);

}  // namespace eyrie::equalizer
