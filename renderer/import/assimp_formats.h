// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace eyrie::import {

/// A format that Assimp reads and this project has tried.
struct AssimpFormat {
    std::string_view extension;  ///< lower case, with its dot
    bool isYUp;  ///< its models stand on the plane y = 0, in Assimp's hands at least, but for FBX
                 ///< that says otherwise
    bool hasLinearColours;  ///< not as displayed (sRGB)
    /// Where a material has a texture, it stands for the diffuse colour; otherwise both multiply.
    bool texturesReplaceColours;

    bool isGltf() const { return extension == ".gltf" || extension == ".glb"; }
};
std::span<const AssimpFormat> assimpFormats();

/// The format of a file by its name's ending; null when it is none of these.
const AssimpFormat* findAssimpFormat(const std::string& path);

}  // namespace eyrie::import
