// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/seen_boxes.h"
#include "renderer/mesh/lattice.h"

namespace eyrie::draw {

/// Indices that follow each other in a node's list.
struct SeenRun {
    GLsizei first = 0;
    GLsizei end = 0;
};

/// Those of the blocks of which a channel may see something; none touches the next.
std::vector<SeenRun> seenRuns(std::span<const mesh::TriangleBlock> blocks,
                              const mesh::Lattice& lattice, const SeenBoxes& seen);

/// The triangles of a node of which a channel may see something: all of them where all of the node
/// is in the channel, else those of some of its blocks (mesh::TriangleBlock).
class SeenTriangles {
public:
    /// `node`, which outlives it, lies within `bounds`; object space.
    SeenTriangles(const DeviceNode& node, const fabric::Box& bounds, const mesh::Lattice& lattice,
                  const SeenBoxes& seen);

    /// Those of some of the node's indices that may be seen, in their order.
    void draw(GLsizei first, GLsizei count) const;

private:
    const DeviceNode& node_;
    std::vector<SeenRun> runs_;
};

}  // namespace eyrie::draw
