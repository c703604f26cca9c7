// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/near_triangles.h"

#include <algorithm>
#include <array>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::draw {
namespace {

template <typename T>
void readBack(const gl::Buffer& buffer, GLintptr offset, std::vector<T>& into) {
    glGetNamedBufferSubData(buffer.id(), offset, static_cast<GLsizeiptr>(into.size() * sizeof(T)),
                            into.data());
}

}  // namespace

const NearTriangles::Kept& NearTriangles::read(std::uint32_t node, const DeviceNode& drawn) {
    const auto known = std::ranges::find(kept_, node, &Kept::node);
    if (known != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, known);
        return kept_.front();
    }
    Kept& kept = kept_.emplace_front();
    kept.node = node;
    kept.positions.resize(file_.nodes()[node].vertexCount);
    kept.indices.resize(static_cast<std::size_t>(drawn.indexCount));
    readBack(drawn.buffer, 0, kept.positions);
    readBack(drawn.buffer, drawn.indexOffset, kept.indices);
    if (kept_.size() > kMostNodes)
        kept_.pop_back();
    return kept;
}

TrianglesOf NearTriangles::of(std::uint32_t node, const DeviceNode& drawn) {
    return [this, node, &drawn](const mesh::TriangleBlock& block, const VisitTriangle& visit) {
        const Kept& kept = read(node, drawn);
        for (std::uint32_t i = block.first; i < block.first + block.count; i += 3) {
            std::array<fabric::Vec3, 3> corners;
            for (std::size_t j = 0; j < 3; ++j)
                corners[j] = file_.lattice().metres(
                    mesh::unpackPosition(kept.positions[kept.indices[i + j]]));
            visit(corners);
        }
    };
}

}  // namespace eyrie::draw
