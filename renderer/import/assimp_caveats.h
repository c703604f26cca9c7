// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "renderer/import/assimp_formats.h"

namespace eyrie::import {

/// What Assimp is known to get wrong or to leave out in a file, for TriangleMesh::notes.
std::vector<std::string> caveats(std::span<const std::byte> bytes, const AssimpFormat& format);

}  // namespace eyrie::import
