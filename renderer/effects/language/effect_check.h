// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <absl/status/status.h>

#include "renderer/effects/language/effect_model.h"

namespace eyrie::effects {

/// Combinations of parameters that the build validates one by one.
inline constexpr int kMaxVariants = 512;

/// Whether `name` is lower_case.effect or lower_case.block: it makes a C++ class and a file name.
bool isEffectFileName(std::string_view name);

/// What the grammar cannot see: types and states that exist, names used once and free in C++,
/// lengths that are parameters, ranges in bounds, two stages. InvalidArgument, with the place.
absl::Status checkEffect(const Effect& effect);

/// The same for a block by itself.
absl::Status checkBlock(const EffectFile& block);

/// A parameter's name in C++: LIGHT_COUNT is lightCount.
std::string memberName(const Parameter& parameter);

}  // namespace eyrie::effects
