// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

namespace eyrie::import {
namespace {

/// AC3D multiplies, but with emissive and ambient parts that are not drawn here and make up for
/// what the diffuse colour lacks.
constexpr std::array kFormats = {
    AssimpFormat{".3ds", true, false, true},     AssimpFormat{".3mf", false, false, true},
    AssimpFormat{".ac", true, false, true},      AssimpFormat{".ac3d", true, false, true},
    AssimpFormat{".acc", true, false, true},     AssimpFormat{".amf", false, false, true},
    AssimpFormat{".ase", true, false, true},     AssimpFormat{".b3d", true, false, false},
    AssimpFormat{".blend", false, false, true},  AssimpFormat{".cob", false, false, true},
    AssimpFormat{".dae", true, false, true},     AssimpFormat{".dxf", true, false, true},
    AssimpFormat{".fbx", true, false, true},     AssimpFormat{".glb", true, true, false},
    AssimpFormat{".gltf", true, true, false},    AssimpFormat{".ifc", true, false, false},
    AssimpFormat{".ifczip", true, false, false}, AssimpFormat{".iqm", true, false, true},
    AssimpFormat{".lwo", true, false, true},     AssimpFormat{".lxo", true, false, true},
    AssimpFormat{".md2", true, false, true},     AssimpFormat{".md3", true, false, true},
    AssimpFormat{".md5mesh", true, false, true}, AssimpFormat{".mdc", true, false, true},
    AssimpFormat{".ms3d", true, false, false},   AssimpFormat{".obj", false, false, false},
    AssimpFormat{".off", false, false, false},   AssimpFormat{".sib", true, false, true},
    AssimpFormat{".smd", false, false, true},    AssimpFormat{".stl", false, false, false},
    AssimpFormat{".x", true, false, false},      AssimpFormat{".x3d", true, false, true},
    AssimpFormat{".zae", true, false, true},
};

}  // namespace

std::span<const AssimpFormat> assimpFormats() { return kFormats; }

const AssimpFormat* findAssimpFormat(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto* found =
        std::find_if(kFormats.begin(), kFormats.end(),
                     [&](const AssimpFormat& format) { return format.extension == extension; });
    return found == kFormats.end() ? nullptr : found;
}

}  // namespace eyrie::import
