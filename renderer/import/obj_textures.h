// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace eyrie::import {

/// What `map_Kd`, in whatever case, says of a material: name, and where a place of the source lies
/// on it, at scale * place + offset, v upwards.
struct ObjTexture {
    std::string name;
    glm::vec2 scale{1, 1};
    glm::vec2 offset{0, 0};

    bool operator==(const ObjTexture&) const = default;
};

/// What follows `map_Kd`. Of options those that scale and shift (-s, -o) are taken, of one to
/// three numbers each; others are passed over.
ObjTexture parseMapKd(std::string_view arguments);

/// The names of all textures of an .mtl file, sorted.
std::vector<std::string> texturesOfMtl(std::string_view mtl);

/// The names that follow `mtllib`: each ends with ".mtl", in whatever case, before a blank, and
/// may have blanks in it; the last ends with the line.
std::vector<std::string> namesOfLibraries(std::string_view arguments);

/// The names of all material files of an OBJ, sorted, each once.
std::vector<std::string> librariesOfObj(std::string_view obj);

/// An .mtl file without what stands before its first `newmtl`, which is no material's. Assimp fails
/// on textures there, passes over a first line that is indented, and refuses a file of one byte to
/// seven; it takes an empty one.
std::string_view fromFirstMaterial(std::string_view mtl);

/// What Assimp is to read of a material file: that, colours of one number as the three that they
/// stand for, no colours of other kinds (CIE's x y z, spectra), for which it refuses the file, and
/// opacities without `-halo`, which it takes for a number.
std::string mtlForAssimp(std::string_view mtl);

/// What an .mtl file says of a material.
struct ObjMaterial {
    bool hasColour = false;       ///< Kd, of numbers
    bool hasOtherColour = false;  ///< Kd in another way, which is not read
    ObjTexture texture;           ///< the last; without a name where it has none
};

/// The materials of an .mtl file by their names.
std::map<std::string, ObjMaterial> objMaterialsOf(std::string_view mtl);

}  // namespace eyrie::import
