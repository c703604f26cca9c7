// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_split.h"

#include <algorithm>
#include <array>
#include <utility>

#include <glm/vec3.hpp>

#include "renderer/mesh/lattice_box.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::import {
namespace {

/// Three times the centroid.
glm::uvec3 centroidOf(const SpooledTriangle& triangle) {
    return mesh::unpackPosition(triangle.positions[0]) +
           mesh::unpackPosition(triangle.positions[1]) +
           mesh::unpackPosition(triangle.positions[2]);
}

class Splitter {
public:
    Splitter(MeshSplit& split, std::uint64_t most, const ImportControl& control)
        : split_(split), most_(most), control_(control) {}

    absl::Status run(std::uint64_t count) {
        total_ = static_cast<double>(count);
        split_.nodes.push_back({.begin = 0, .end = count});
        return visit(0);
    }

private:
    absl::Status visit(std::size_t index);
    absl::Status halve(std::size_t index);

    MeshSplit& split_;
    std::uint64_t most_;
    const ImportControl& control_;
    double total_ = 1;
    double done_ = 0;  ///< triangles in parts
};

absl::Status Splitter::visit(std::size_t index) {
    RETURN_IF_ERROR(control_.check());
    const SplitNode node = split_.nodes[index];
    const auto firstPart = static_cast<std::uint32_t>(split_.parts.size());
    if (node.end - node.begin <= most_) {
        split_.parts.push_back(static_cast<std::uint32_t>(index));
        done_ += static_cast<double>(node.end - node.begin);
        control_.report("tree", done_ / total_);
    } else {
        RETURN_IF_ERROR(halve(index));
        const std::uint64_t middle = node.begin + (node.end - node.begin) / 2;
        for (const bool isLeft : {true, false}) {
            const auto child = static_cast<std::int32_t>(split_.nodes.size());
            (isLeft ? split_.nodes[index].left : split_.nodes[index].right) = child;
            split_.nodes.push_back({.begin = isLeft ? node.begin : middle,
                                    .end = isLeft ? middle : node.end,
                                    .file = 1 - node.file});
            RETURN_IF_ERROR(visit(static_cast<std::size_t>(child)));
        }
    }
    split_.nodes[index].firstPart = firstPart;
    split_.nodes[index].lastPart = static_cast<std::uint32_t>(split_.parts.size()) - 1;
    return absl::OkStatus();
}

/// Writes the lesser half of a node's triangles, and then the other, to the other file. A
/// centroid's coordinate has so few values that they are counted one by one.
absl::Status Splitter::halve(std::size_t index) {
    const SplitNode& node = split_.nodes[index];
    const RowFile<SpooledTriangle>& from = split_.triangles[node.file];
    mesh::LatticeBox bounds;
    RETURN_IF_ERROR(
        from.forBlocks(node.begin, node.end, [&](std::span<const SpooledTriangle> block) {
            for (const SpooledTriangle& row : block) bounds.grow(centroidOf(row));
            return control_.check();
        }));
    const int axis = bounds.longestAxis();
    std::vector<std::uint32_t> counts(bounds.max[axis] - bounds.min[axis] + 1, 0);
    RETURN_IF_ERROR(
        from.forBlocks(node.begin, node.end, [&](std::span<const SpooledTriangle> block) {
            for (const SpooledTriangle& row : block)
                ++counts[centroidOf(row)[axis] - bounds.min[axis]];
            return control_.check();
        }));
    std::uint64_t missing = (node.end - node.begin) / 2;  // of the lesser half
    std::uint32_t median = 0;
    while (counts[median] <= missing) missing -= counts[median++];
    const std::array begins{node.begin, node.begin + (node.end - node.begin) / 2};
    RowGroups<SpooledTriangle> halves(split_.triangles[1 - node.file], begins);
    const auto addAll = [&](std::span<const SpooledTriangle> block) {
        for (const SpooledTriangle& row : block) {
            const std::uint32_t at = centroidOf(row)[axis] - bounds.min[axis];
            const bool isLess = at < median || (at == median && missing > 0);
            missing -= at == median && isLess ? 1 : 0;
            RETURN_IF_ERROR(halves.add(isLess ? 0 : 1, row));
        }
        return control_.check();
    };
    RETURN_IF_ERROR(from.forBlocks(node.begin, node.end, addAll));
    return halves.finish();
}

}  // namespace

absl::StatusOr<MeshSplit> splitMesh(MeshSpool& spool, std::uint64_t most,
                                    const std::string& outPath, const ImportControl& control) {
    control.report("tree", 0);
    ASSIGN_OR_RETURN(auto other, RowFile<SpooledTriangle>::create(outPath));
    MeshSplit split;
    split.triangles.push_back(std::move(spool.triangles));
    split.triangles.push_back(std::move(other));
    RETURN_IF_ERROR(Splitter(split, most, control).run(spool.triangleCount));
    return split;
}

}  // namespace eyrie::import
