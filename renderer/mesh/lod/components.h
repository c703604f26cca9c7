// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lod/patch.h"
#include "renderer/mesh/lod/sheet_ends.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// The pieces of a mesh that share no point, as thousands of objects in one model do.
class Components {
public:
    /// Those that have a vertex of `goesOnAt` lie whole under no node.
    Components(const PackedMesh& mesh, const KdTree& tree, const SheetEnds& ends,
               std::span<const std::uint32_t> goesOnAt = {});

    /// Of a vertex; below count(). Vertices at one position are of one component.
    std::uint32_t of(std::uint32_t vertex) const { return ofVertex_[vertex]; }
    std::size_t count() const { return first_.size(); }

    /// Whether all of it lies under the node, and it closes no gap between others
    /// (closing_pieces.h).
    bool mayGo(std::uint32_t component, const KdNode& node) const {
        return first_[component] >= node.triangleBegin && last_[component] < node.triangleEnd &&
               !isClosing_[component];
    }

private:
    std::vector<std::uint32_t> ofVertex_;
    std::vector<std::uint64_t> first_;  ///< places in the tree's order
    std::vector<std::uint64_t> last_;
    std::vector<bool> isClosing_;
};

/// Takes whole components away, each time that with the least bound, until at most `target`
/// triangles are left or none has a bound of `limitSteps` at most.
///
/// All of a component goes to one point that stays, the vertex of another component nearest to its
/// middle: the triangle there bears the bound of the way (patch.h). Only components that lie whole
/// under `node` and close no gap go, so nothing that is drawn beside the patch loses a neighbour.
void dropComponents(const PackedMesh& mesh, const Components& components, const KdNode& node,
                    std::size_t target, double limitSteps, Patch& patch);

}  // namespace eyrie::mesh
