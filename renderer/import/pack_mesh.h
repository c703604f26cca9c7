// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <absl/status/statusor.h>

#include "renderer/import/orient.h"
#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::import {

/// Where normals come from.
enum class NormalSource {
    ByFormat,  ///< importMesh: the file's of formats that state them; else, and elsewhere, smooth
    Smooth,    ///< the mean around each vertex
    Crease,    ///< the same within PackOptions::creaseDegrees
    File,      ///< the source's; smooth where it has none, or one without a length
};

struct PackOptions {
    /// Of a coordinate, 8 to 21: the longest side has 2^(bits-1) steps of the lattice or more.
    int latticeBits = mesh::kLatticeBits;
    std::optional<mesh::Lattice> lattice = {};  ///< that to use, fitted to more than the mesh
    bool keepsExact = false;  ///< the source's positions bit for bit, too: PackedMesh::exact
    NormalSource normals = NormalSource::ByFormat;
    double creaseDegrees = 45;  ///< of NormalSource::Crease: edges that are sharper stay sharp
    bool orients = false;       ///< makes the winding consistent (orient.h)
};

/// What packing left out, put together and turned.
struct PackCounts {
    std::uint64_t isolatedVertices = 0;     ///< used by no triangle
    std::uint64_t weldedVertices = 0;       ///< became one with an equal vertex before them
    std::uint64_t degenerateTriangles = 0;  ///< without area on the lattice: they cover no pixel
    std::uint64_t emptyTriangles = 0;       ///< of these, without it in the source, too
    std::uint64_t duplicateTriangles = 0;   ///< that one before them, wound the same way, hides
    OrientCounts orient;                    ///< where PackOptions::orients
    bool normalsComputed = false;           ///< for all vertices, or for those with unusable ones

    bool operator==(const PackCounts&) const = default;
};

/// Whether a triangle has no area where its source has its corners.
bool isEmpty(const std::array<fabric::Vec3, 3>& corners);

/// InvalidArgument: no triangle is left of so many, since none has any area, if `stepMetres` is not
/// 0 on a lattice of such steps.
absl::Status nothingHasArea(std::uint64_t triangles, double stepMetres = 0);

/// Puts a mesh on the lattice that fits it: rounds positions, drops triangles without area and
/// duplicates (duplicate_faces.h; glass hides no wall), welds vertices that have become equal
/// (position, normal, colour, material and texture coordinates; if it keeps exact positions, those,
/// too).
///
/// Depends on the mesh and the options alone. Every remaining vertex lies within
/// errorMetres() of where its file states it.
/// Preconditions: images are loaded (texture_files.h).
/// Errors: Cancelled, InvalidArgument (coordinates too large, or nothing has any area).
absl::StatusOr<mesh::PackedMesh> packMesh(TriangleMesh source, PackCounts& counts,
                                          const PackOptions& options = {},
                                          const ImportControl& control = {});

}  // namespace eyrie::import
