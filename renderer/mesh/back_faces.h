// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fabric/box.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lids.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// Triangles, ascending, that an eye outside the mesh's bounds may see from behind, other than
/// through a lid.
///
/// A mesh that with its lids passes each edge as often one way as the other winds each point of
/// space a whole number of times, and those outside not at all. So whoever looks at a back from
/// outside, and through no lid, looks through points that are wound less than no times, up to the
/// triangle: such pockets are where the mesh goes through itself, or is inside out. The number is
/// counted before each triangle's middle, two lattice steps along z (rounding pushes thin walls
/// through each other). Pockets that reach no triangle's middle escape, and triangles along z are
/// not asked.
///
/// Nothing where it would take too long to tell.
std::optional<std::vector<std::uint32_t>> seenFromBehind(const PackedMesh& mesh, const Lids& lids);

/// Where the pockets under a node are: boxes around the triangles that are seen from behind, in
/// lattice steps, those together that are near each other, in a few dozen boxes at most.
class Pockets {
public:
    /// Takes the whole of space for one.
    void addAll();
    void add(fabric::Box box);
    void add(const Pockets& others);

    /// Whether a pocket comes within `steps` of the box.
    bool reach(const fabric::Box& box, double steps) const;

private:
    fabric::Box& nearest(const fabric::Box& box);

    std::vector<fabric::Box> boxes_;
    bool isEverywhere_ = false;
};

/// For each node of `tree` the pockets under it, where `isBehind` says of each triangle of the mesh
/// whether it is seen from behind.
std::vector<Pockets> gatherPockets(const PackedMesh& mesh, const KdTree& tree,
                                   const std::vector<bool>& isBehind);

/// Where that is not known.
std::vector<Pockets> pocketsEverywhere(const KdTree& tree);

/// For each node of `tree` the pockets under it: everywhere where there are no `lids`,
/// seenFromBehind() gives nothing, or a material lets the eye in. What stands for a node shows its
/// back to nobody outside who does not look through a lid, but to within its error, where no pocket
/// comes within its error (docs/errors.md#back-faces).
std::vector<Pockets> findPockets(const PackedMesh& mesh, const std::optional<Lids>& lids,
                                 const KdTree& tree);

/// Where a mesh may be seen from behind.
struct Backs {
    std::vector<Pockets> pockets;   ///< by node
    std::vector<fabric::Box> lids;  ///< in lattice steps
};
Backs findBacks(const PackedMesh& mesh, const KdTree& tree);

/// The box of a triangle, in lattice steps.
fabric::Box boxOf(const PackedMesh& mesh, const Triangle& triangle);

}  // namespace eyrie::mesh
