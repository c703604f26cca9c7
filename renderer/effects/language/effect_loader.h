// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "renderer/effects/language/effect_model.h"

namespace eyrie::effects {

/// The text of the file called `name`, without a folder.
using ReadEffectFile = std::function<absl::StatusOr<std::string>(std::string_view name)>;

/// Reads from `folder`. NotFound, or InvalidArgument for a file too large to be an effect.
ReadEffectFile effectFolder(std::filesystem::path folder);

/// Reads, parses and checks NAME.effect and the blocks that it includes.
/// Errors: those of `read`, and InvalidArgument as "FILE:LINE:COLUMN: message".
absl::StatusOr<Effect> loadEffect(std::string_view name, const ReadEffectFile& read);

/// The same for NAME.block by itself.
absl::StatusOr<EffectFile> loadBlock(std::string_view name, const ReadEffectFile& read);

}  // namespace eyrie::effects
