// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "renderer/import/mesh_synth.h"
#include "renderer/import/pack_mesh.h"
#include "renderer/mesh/node_geometry.h"
#include "renderer/mesh/triangle_blocks.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::draw {

/// A rough ball of about unit radius as one node.
class BallOfBlocks {
public:
    BallOfBlocks() {
        import::PackCounts counts;
        mesh_ = import::packMesh(import::synthesizeMesh(20000, 5), counts).value();
        const std::array<std::span<const mesh::Triangle>, 1> all{mesh_.triangles};
        node_ = mesh::gatherNode(mesh_, all);
        mesh::NodeGeometry geometry;
        geometry.positions = node_.positions;
        geometry.indices = node_.indices;
        blocks_ = mesh::triangleBlocks(geometry);
    }

    const mesh::Lattice& lattice() const { return mesh_.lattice; }
    std::span<const mesh::TriangleBlock> blocks() const { return blocks_; }
    fabric::Box boxOf(const mesh::TriangleBlock& block) const {
        return {lattice().metres(block.bounds.min), lattice().metres(block.bounds.max)};
    }
    /// Of triangle index / 3.
    fabric::Vec3 corner(std::size_t index) const {
        return lattice().metres(mesh::unpackPosition(node_.positions[node_.indices[index]]));
    }
    std::size_t indices() const { return node_.indices.size(); }

private:
    mesh::PackedMesh mesh_;
    mesh::PackedNode node_;
    std::vector<mesh::TriangleBlock> blocks_;
};

}  // namespace eyrie::draw
