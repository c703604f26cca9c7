// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <assimp/IOSystem.hpp>

#include "renderer/import/assimp_formats.h"

namespace eyrie::import {

/// How Assimp opens the file of a format at `path`, and those that it names: those of glTF by their
/// URIs, material files as textures (findTexture), and X3D, COLLADA, AMF, DXF, OBJ and OFF, those
/// that others include too, as it understands them (x3d_text.h, collada_text.h, amf_text.h,
/// dxf_text.h, obj_text.h, off_text.h).
std::unique_ptr<Assimp::IOSystem> assimpFiles(const AssimpFormat& format, const std::string& path);

}  // namespace eyrie::import
