// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace eyrie::import {

/// An AMF file without the angles of its instances (ISO/ASTM 52915), which Assimp 5.2 takes for the
/// places, and with one volume a mesh (amf_volumes.h); nothing for one that is so.
std::optional<std::string> amfForAssimp(std::string_view amf);

/// For TriangleMesh::notes: how many instances are turned, which are left as they are, and how many
/// objects have several meshes, of which one is read.
std::vector<std::string> amfCaveats(std::string_view amf);

}  // namespace eyrie::import
