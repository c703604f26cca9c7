// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <absl/status/status.h>

namespace eyrie::mesh {

/// Keeps in an .eym file, which nobody has open, that a measurement chose the triangles its leaves
/// may have (EymFile::tunedLeafTriangles). Errors: those of EymFile::open; Unavailable when the
/// file cannot be written.
absl::Status recordTunedLeaf(const std::string& path, std::uint32_t leafTriangles);

}  // namespace eyrie::mesh
