// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "fabric/image.h"
#include "fabric/vec.h"

namespace eyrie::import {

/// A mesh as its source gives it, in the source's own units (taken as metres) and order.
///
/// Invariant of every reader: positions are finite and every corner is below positions.size().
/// `normals` and `colours` are empty or have one entry a position; normals may have any length,
/// zero and not-a-number included.
struct TriangleMesh {
    std::vector<fabric::Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
    std::vector<glm::vec3> normals;
    std::vector<fabric::Rgba> colours;
    std::uint64_t droppedFaces = 0;  ///< faces of the source with fewer than three corners
    std::vector<std::string> notes;  ///< what was odd in the source; a line each

    bool operator==(const TriangleMesh&) const = default;
};

}  // namespace eyrie::import
