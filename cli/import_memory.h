// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie::cli {

/// What the import of a mesh may take where nobody said: half of what this machine has, or of what
/// its control group may use.
std::uint64_t defaultMeshMemory();

}  // namespace eyrie::cli
