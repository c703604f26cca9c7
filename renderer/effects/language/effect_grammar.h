// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "renderer/effects/language/effect_model.h"

namespace eyrie::effects {

/// What one file may hold. Parsing takes time proportional to the text and no recursion.
inline constexpr std::size_t kMaxEffectBytes = std::size_t{1} << 20;
inline constexpr int kMaxBraceDepth = 64;

/// Parses one effect file or block; docs/effects.md has the grammar. Looks at nothing but the text:
/// whether names agree is checkEffect's to say. InvalidArgument, as "NAME:LINE:COLUMN: expected …".
absl::StatusOr<EffectFile> parseEffectFile(std::string_view text, std::string_view name);

}  // namespace eyrie::effects
