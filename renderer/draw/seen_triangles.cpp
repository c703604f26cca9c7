// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/seen_triangles.h"

#include <algorithm>
#include <cstdint>

namespace eyrie::draw {

std::vector<SeenRun> seenRuns(std::span<const mesh::TriangleBlock> blocks,
                              const mesh::Lattice& lattice, const SeenBoxes& seen) {
    std::vector<SeenRun> runs;
    for (const mesh::TriangleBlock& block : blocks) {
        if (!seen.sees({lattice.metres(block.bounds.min), lattice.metres(block.bounds.max)}))
            continue;
        const auto first = static_cast<GLsizei>(block.first);
        if (runs.empty() || runs.back().end != first)
            runs.push_back({first, first});
        runs.back().end += static_cast<GLsizei>(block.count);
    }
    return runs;
}

SeenTriangles::SeenTriangles(const DeviceNode& node, const fabric::Box& bounds,
                             const mesh::Lattice& lattice, const SeenBoxes& seen)
    : node_(node) {
    if (seen.seesAll(bounds))
        runs_.push_back({0, node.indexCount});
    else
        runs_ = seenRuns(node.blocks, lattice, seen);
}

void SeenTriangles::draw(GLsizei first, GLsizei count) const {
    std::vector<GLsizei> counts;
    std::vector<const void*> offsets;
    for (const SeenRun& run : runs_) {
        const GLsizei begin = std::max(first, run.first);
        const GLsizei end = std::min(first + count, run.end);
        if (begin >= end)
            continue;
        counts.push_back(end - begin);
        offsets.push_back(reinterpret_cast<const void*>(
            node_.indexOffset + begin * static_cast<GLintptr>(sizeof(std::uint16_t))));
    }
    if (!counts.empty())
        glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_SHORT, offsets.data(),
                            static_cast<GLsizei>(counts.size()));
}

}  // namespace eyrie::draw
