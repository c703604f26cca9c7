// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

#include "renderer/effects/language/effect_model.h"

namespace eyrie::effects {

/// Runs glslangValidator at path `validator` on every variant of `effect`, with the stages linked
/// of as many as have each value of each parameter. InvalidArgument with what it says of the first
/// variant that fails, each line of it beginning with the effect file and line it is about;
/// FailedPrecondition when it cannot be run.
absl::Status validateGlsl(const Effect& effect, const std::string& validator);

}  // namespace eyrie::effects
