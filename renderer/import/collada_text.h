// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::import {

/// A COLLADA file as Assimp 5.2 takes it for what the format means (Khronos, COLLADA 1.4.1): with
/// matrices for the skews of nodes, of which Assimp ends the program, and with textures that name
/// their coordinates as it understands it: by a digit that says which of a mesh's sets it is, from
/// 0. It passes over <bind_vertex_input>, which says what set a name stands for, and takes the
/// "CHANNEL1" of 3ds Max, whatever it is bound to, for the second. Names that nothing binds stay.
/// Sets count from the lowest that any mesh has. Files that are packed (.zae) do not come here.
std::string colladaForAssimp(std::string_view collada);

}  // namespace eyrie::import
