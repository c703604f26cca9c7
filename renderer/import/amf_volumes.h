// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace eyrie::import {

/// An AMF file whose meshes have one volume each, as Assimp 5.2 passes over all but the first:
/// the triangles of the others are put into that, with the colour that these have, by themselves,
/// their material or their object, unless vertices have colours, which come first. Nothing where no
/// mesh has several.
std::optional<std::string> withJoinedVolumes(std::string_view amf);

}  // namespace eyrie::import
