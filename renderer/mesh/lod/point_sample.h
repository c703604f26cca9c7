// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lod/patch.h"
#include "renderer/mesh/lod/surface_colours.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// The first points of a sample, which stand for all of the surface, only farther apart.
struct PointPrefix {
    std::uint32_t points = 0;
    double errorSteps = 0;  ///< as PointSample has it, of these alone
};

/// Points on a surface, the coarsest choice of them first: any prefix is a coarser sample. No point
/// of the source's surface is farther than `errorSteps` from one of the points, and none of them
/// is farther than that from the source.
struct PointSample {
    std::vector<std::uint64_t> positions;  ///< packed, on the lattice
    std::vector<std::uint32_t> normals;    ///< packed; see samplePoints
    /// Empty where the mesh has neither colours nor images. Alpha is kPointSides' of the material.
    std::vector<std::uint32_t> colours;
    std::vector<PointPrefix> prefixes;  ///< the last has all points

    double errorSteps() const { return prefixes.back().errorSteps; }
};

/// What alpha says of a point: whether it is seen from behind.
enum PointSides : std::uint8_t {
    kSeenFromFront = 0,  ///< its material is one-sided
    kSeenFromBoth = 255,
};

/// Samples `patch` by at most `mostPoints` points, or does not: where something is blended, where
/// all of it is holes, and where the sample's error would be above `mostErrorSteps`.
///
/// Points are chosen out of a dense set by throwing darts: each goes in that has none within a
/// radius; of those in turn that have none within larger ones the first come first. A point's
/// normal is the surface's own, that of shading, but for one-sided materials the triangle's. R. L.
/// Cook, "Stochastic Sampling in Computer Graphics", 1986.
std::optional<PointSample> samplePoints(const PackedMesh& mesh, const Patch& patch,
                                        const SurfaceColours& colours, std::size_t mostPoints,
                                        double mostErrorSteps);

}  // namespace eyrie::mesh
