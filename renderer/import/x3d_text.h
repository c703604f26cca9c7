// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::import {

/// An X3D file as Assimp 5.2 takes it for what the format means (ISO/IEC 19775-1 and 19776-1):
/// of an image's names the first, without its quotes and with %20 for its spaces, as Assimp
/// refuses "wall.png" and loses spaces; the centre of a texture's transform so that Assimp, which
/// takes it away from the translation and knows it no more, comes to the same places; strips of
/// triangles, for which Assimp refuses the file, as those with indices; a plain material for shapes
/// that have none, to which it gives that of another shape; indices of faces whose corners go
/// clockwise the other way around, as it does not ask which way they go; and blanks for commas
/// between numbers, behind which it looks for nothing but blanks.
std::string x3dForAssimp(std::string_view x3d);

}  // namespace eyrie::import
