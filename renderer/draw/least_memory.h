// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <absl/status/status.h>

#include "renderer/draw/drawable.h"

namespace eyrie::draw {

/// ResourceExhausted, with the limit that is short and its option, unless `share`, an object's of
/// the renderer's memory, holds the `least` that it can be drawn with. `textureBytes`: of that on
/// the device, for a mesh's textures.
absl::Status checkHolds(const MemoryUse& share, const MemoryUse& least, std::string_view path,
                        std::uint64_t textureBytes = 0);

}  // namespace eyrie::draw
