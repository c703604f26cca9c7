// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/import/assimp_formats.h"

namespace eyrie::import {

/// Metres of the unit that a file of AMF (the attribute `unit`; millimetres without it) or X3D
/// (UNIT, of the category length; metres without it) names, of which Assimp 5.2 makes nothing; 1 of
/// other formats. A unit that is none is told in `notes`, for TriangleMesh::notes, and taken for
/// metres.
double statedUnitOf(std::string_view text, const AssimpFormat& format,
                    std::vector<std::string>& notes);

}  // namespace eyrie::import
