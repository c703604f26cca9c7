// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_writer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <oneapi/tbb/parallel_for.h>

#include "fabric/status.h"
#include "renderer/mesh/back_faces.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/node_geometry.h"

namespace eyrie::mesh {
namespace {

constexpr std::uint64_t kIndexAlignment = 4;  // four 16-bit indices: 8 bytes

std::uint64_t aligned(std::uint64_t value, std::uint64_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

/// The least float that is not below `value`: an upper bound stays one.
float roundedUp(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest >= value ? nearest
                            : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

std::vector<Triangle> trianglesOf(const PackedMesh& mesh, const KdTree& tree, const KdNode& leaf) {
    std::vector<Triangle> triangles;
    triangles.reserve(leaf.triangleEnd - leaf.triangleBegin);
    for (std::uint64_t i = leaf.triangleBegin; i < leaf.triangleEnd; ++i)
        triangles.push_back(mesh.triangles[tree.order[i]]);
    return triangles;
}

/// Those that show their backs to nobody come first.
PackedNode gatherNode(const PackedMesh& mesh, std::vector<Triangle> triangles,
                      const Pockets& pockets, double errorSteps) {
    const auto others =
        std::stable_partition(triangles.begin(), triangles.end(), [&](const Triangle& triangle) {
            return !pockets.reach(boxOf(mesh, triangle), errorSteps);
        });
    return gatherNode(mesh, {triangles.begin(), others}, {others, triangles.end()});
}

std::vector<PackedNode> gatherNodes(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
                                    const std::stop_token& stop) {
    std::vector<PackedNode> nodes(tree.nodes.size());
    const std::vector<Pockets> pockets = findPockets(mesh, tree);
    oneapi::tbb::parallel_for(std::size_t{0}, tree.nodes.size(), [&](std::size_t i) {
        const KdNode& node = tree.nodes[i];
        if (!stop.stop_requested())
            nodes[i] =
                gatherNode(mesh, node.isLeaf() ? trianglesOf(mesh, tree, node) : lod.geometry[i],
                           pockets[i], lod.errorMetres[i] / mesh.lattice.stepMetres);
    });
    return nodes;
}

std::vector<Node> layOutNodes(const KdTree& tree, const LodTree& lod,
                              const std::vector<PackedNode>& packed) {
    std::vector<Node> nodes(tree.nodes.size());
    std::uint64_t vertices = 0;
    std::uint64_t indices = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const KdNode& from = tree.nodes[i];
        Node& node = nodes[i];
        node.boxMin = from.boxMin;
        node.boxMax = from.boxMax;
        node.left = from.left;
        node.right = from.right;
        node.triangleBegin = from.triangleBegin;
        node.triangleEnd = from.triangleEnd;
        node.firstVertex = vertices;
        node.firstIndex = indices;
        node.vertexCount = static_cast<std::uint32_t>(packed[i].positions.size());
        node.indexCount = static_cast<std::uint32_t>(packed[i].indices.size());
        node.errorMetres = roundedUp(lod.errorMetres[i]);
        node.frontIndexCount = packed[i].frontIndexCount;
        node.checksum = geometryChecksum(
            {packed[i].positions, packed[i].normals, packed[i].colours, packed[i].indices});
        vertices += node.vertexCount;
        indices = aligned(indices + node.indexCount, kIndexAlignment);
    }
    return nodes;
}

std::uint64_t countUsedVertices(const PackedMesh& mesh) {
    std::vector<bool> used(mesh.positions.size());
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) used[corner] = true;
    return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
}

EymHeader makeHeader(const PackedMesh& mesh, const std::vector<Node>& nodes,
                     std::uint64_t sourceHash) {
    EymHeader header;
    header.sourceHash = sourceHash;
    header.triangleCount = mesh.triangles.size();
    header.sourceVertexCount = countUsedVertices(mesh);
    header.vertexCount = nodes.back().firstVertex + nodes.back().vertexCount;
    header.indexCount = aligned(nodes.back().firstIndex + nodes.back().indexCount, kIndexAlignment);
    header.nodeCount = static_cast<std::uint32_t>(nodes.size());
    header.originMetres = {mesh.lattice.originMetres.x, mesh.lattice.originMetres.y,
                           mesh.lattice.originMetres.z};
    header.stepMetres = mesh.lattice.stepMetres;
    header.coarsestErrorMetres = nodes.front().errorMetres;
    header.finestErrorMetres = nodes.back().errorMetres;
    header.nodesOffset = sizeof(EymHeader);
    header.positionsOffset = header.nodesOffset + nodes.size() * sizeof(Node);
    header.normalsOffset = header.positionsOffset + header.vertexCount * sizeof(std::uint64_t);
    std::uint64_t end =
        aligned(header.normalsOffset + header.vertexCount * sizeof(std::uint32_t), 8);
    if (!mesh.colours.empty()) {
        header.flags |= kHasColours;
        header.coloursOffset = end;
        end = aligned(end + header.vertexCount * sizeof(std::uint32_t), 8);
    }
    header.indicesOffset = end;
    header.fileBytes = end + header.indexCount * sizeof(std::uint16_t);
    header.checksum = tableChecksum(header, nodes);
    return header;
}

/// One array of every node, in order, each padded to `alignment` bytes and the whole to 8.
template <typename T>
absl::Status writeSection(std::vector<T> PackedNode::*array, const std::vector<PackedNode>& nodes,
                          std::uint64_t alignment, OutputFile& out, const std::stop_token& stop) {
    for (const PackedNode& node : nodes) {
        if (stop.stop_requested())
            return absl::CancelledError("writing was cancelled");
        RETURN_IF_ERROR(out.write(std::as_bytes(std::span(node.*array))));
        if (alignment > 1)
            RETURN_IF_ERROR(out.padTo(alignment));
    }
    return out.padTo(8);
}

}  // namespace

absl::Status writeEym(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
                      std::uint64_t sourceHash, OutputFile& out, const std::stop_token& stop) {
    const std::vector<PackedNode> packed = gatherNodes(mesh, tree, lod, stop);
    const std::vector<Node> nodes = layOutNodes(tree, lod, packed);
    const EymHeader header = makeHeader(mesh, nodes, sourceHash);
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(&header, 1))));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(nodes))));
    RETURN_IF_ERROR(writeSection(&PackedNode::positions, packed, 1, out, stop));
    RETURN_IF_ERROR(writeSection(&PackedNode::normals, packed, 1, out, stop));
    RETURN_IF_ERROR(writeSection(&PackedNode::colours, packed, 1, out, stop));
    return writeSection(&PackedNode::indices, packed, kIndexAlignment * 2, out, stop);
}

}  // namespace eyrie::mesh
