// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_writer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <oneapi/tbb/parallel_for.h>

#include "fabric/status.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/node_geometry.h"

namespace eyrie::mesh {
namespace {

constexpr std::uint64_t kAlignment = 8;  ///< of uncoded pages

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

/// What a node has in the file.
struct Pages {
    NodeShape shape;
    std::vector<std::byte> page;
    std::vector<std::byte> exact;
    std::uint64_t blockChecksum = 0;
    std::uint32_t frontIndexCount = 0;
};

NodeShape shapeOf(const PackedNode& node) {
    return {static_cast<std::uint32_t>(node.positions.size()),
            static_cast<std::uint32_t>(node.indices.size()), !node.colours.empty()};
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

/// As node_block.h has it.
std::vector<std::byte> blockOf(const PackedNode& node) {
    std::vector<std::uint64_t> block(blockBytes(shapeOf(node)) / 8);
    const NodeArrays arrays(shapeOf(node), block);
    std::copy(node.positions.begin(), node.positions.end(), arrays.positions.begin());
    std::copy(node.normals.begin(), node.normals.end(), arrays.normals.begin());
    std::copy(node.colours.begin(), node.colours.end(), arrays.colours.begin());
    std::copy(node.indices.begin(), node.indices.end(), arrays.indices.begin());
    const auto bytes = std::as_bytes(std::span(block));
    return {bytes.begin(), bytes.end()};
}

class PageMaker {
public:
    PageMaker(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
              std::span<const Pockets> pockets, const EymOptions& options)
        : mesh_(mesh),
          tree_(tree),
          lod_(lod),
          isCoded_(options.isCoded),
          pockets_(pockets),
          exactForm_(options.exactForm.value_or(exactFormOf(mesh.exact))) {}

    ExactForm exactForm() const { return exactForm_; }

    Pages make(std::size_t index) const {
        const KdNode& node = tree_.nodes[index];
        const PackedNode packed = gatherNode(
            mesh_, node.isLeaf() ? trianglesOf(mesh_, tree_, node) : lod_.geometry[index],
            pockets_[index], lod_.errorMetres[index] / mesh_.lattice.stepMetres);
        Pages pages;
        pages.shape = shapeOf(packed);
        pages.frontIndexCount = packed.frontIndexCount;
        if (packed.indices.empty())
            return pages;
        pages.page = blockOf(packed);
        pages.blockChecksum = contentHash(pages.page);
        if (isCoded_)
            pages.page = encodePage(
                {packed.positions, packed.normals, packed.colours, packed.indices, {}, nullptr});
        if (node.isLeaf() && !packed.exact.empty())
            pages.exact = encodeExact(packed.exact, packed.positions, mesh_.lattice, exactForm_);
        return pages;
    }

private:
    const PackedMesh& mesh_;
    const KdTree& tree_;
    const LodTree& lod_;
    bool isCoded_;
    std::span<const Pockets> pockets_;
    ExactForm exactForm_;
};

std::vector<Lid> stored(const std::vector<fabric::Box>& boxes) {
    std::vector<Lid> lids;
    for (const fabric::Box& box : boxes) lids.push_back({glm::uvec3(box.min), glm::uvec3(box.max)});
    return lids;
}

std::vector<Pages> makePages(const KdTree& tree, const PageMaker& maker,
                             const std::stop_token& stop) {
    std::vector<Pages> pages(tree.nodes.size());
    oneapi::tbb::parallel_for(std::size_t{0}, pages.size(), [&](std::size_t i) {
        if (!stop.stop_requested())
            pages[i] = maker.make(i);
    });
    return pages;
}

std::uint64_t aligned(std::uint64_t value) {
    return (value + kAlignment - 1) / kAlignment * kAlignment;
}

/// `end` becomes that of the file.
std::vector<Node> layOutNodes(const KdTree& tree, const LodTree& lod,
                              const std::vector<Pages>& pages, std::size_t lidCount,
                              std::uint64_t& end) {
    std::vector<Node> nodes(tree.nodes.size());
    end = sizeof(EymHeader) + nodes.size() * sizeof(Node) + lidCount * sizeof(Lid);
    const auto place = [&end](const std::vector<std::byte>& page, std::uint64_t& offset,
                              std::uint32_t& bytes, std::uint64_t& checksum) {
        offset = end;
        bytes = static_cast<std::uint32_t>(page.size());
        checksum = contentHash(page);
        end = aligned(end + bytes);
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const KdNode& from = tree.nodes[i];
        Node& node = nodes[i];
        node.boxMin = from.boxMin;
        node.boxMax = from.boxMax;
        node.left = from.left;
        node.right = from.right;
        node.triangleBegin = from.triangleBegin;
        node.triangleEnd = from.triangleEnd;
        node.vertexCount = pages[i].shape.vertexCount;
        node.indexCount = pages[i].shape.indexCount;
        node.errorMetres = roundedUp(lod.errorMetres[i]);
        node.frontIndexCount = pages[i].frontIndexCount;
        if (node.indexCount == 0)
            continue;
        place(pages[i].page, node.pageOffset, node.pageBytes, node.pageChecksum);
        node.blockChecksum = pages[i].blockChecksum;
        if (!pages[i].exact.empty())
            place(pages[i].exact, node.exactOffset, node.exactBytes, node.exactChecksum);
    }
    return nodes;
}

std::uint64_t countUsedVertices(const PackedMesh& mesh) {
    std::vector<bool> used(mesh.positions.size());
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) used[corner] = true;
    return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
}

std::uint32_t flagsOf(const PackedMesh& mesh, const EymOptions& options, ExactForm exactForm) {
    return (mesh.colours.empty() ? 0 : kHasColours) | (options.isCoded ? kIsCoded : 0) |
           (mesh.exact.empty() ? 0 : kHasExact) |
           (exactForm == ExactForm::Float64 ? kExactIsFloat64 : 0);
}

EymHeader makeHeader(const PackedMesh& mesh, const std::vector<Node>& nodes,
                     const std::vector<Lid>& lids) {
    EymHeader header;
    header.nodesChecksum = contentHash(std::as_bytes(std::span(nodes)));
    header.lidsChecksum = contentHash(std::as_bytes(std::span(lids)));
    header.lidCount = lids.size();
    header.triangleCount = mesh.triangles.size();
    header.sourceVertexCount = countUsedVertices(mesh);
    header.nodeCount = static_cast<std::uint32_t>(nodes.size());
    header.originMetres = {mesh.lattice.originMetres.x, mesh.lattice.originMetres.y,
                           mesh.lattice.originMetres.z};
    header.stepMetres = mesh.lattice.stepMetres;
    header.coarsestErrorMetres = nodes.front().errorMetres;
    header.finestErrorMetres = nodes.back().errorMetres;
    return header;
}

absl::Status writePages(const std::vector<Pages>& pages, OutputFile& out,
                        const std::stop_token& stop) {
    for (const Pages& node : pages) {
        if (stop.stop_requested())
            return absl::CancelledError("writing was cancelled");
        for (const auto* page : {&node.page, &node.exact}) {
            RETURN_IF_ERROR(out.write(*page));
            RETURN_IF_ERROR(out.padTo(kAlignment));
        }
    }
    return absl::OkStatus();
}

}  // namespace

absl::Status writeEym(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
                      const Backs& backs, const EymOptions& options, OutputFile& out,
                      const std::stop_token& stop) {
    const PageMaker maker(mesh, tree, lod, backs.pockets, options);
    const std::vector<Pages> pages = makePages(tree, maker, stop);
    std::uint64_t end = 0;
    const std::vector<Lid> lids = stored(backs.lids);
    const std::vector<Node> nodes = layOutNodes(tree, lod, pages, lids.size(), end);
    EymHeader header = makeHeader(mesh, nodes, lids);
    header.flags = flagsOf(mesh, options, maker.exactForm());
    header.sourceHash = options.sourceHash;
    header.fileBytes = end;
    header.checksum = headerChecksum(header);
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(&header, 1))));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(nodes))));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(lids))));
    return writePages(pages, out, stop);
}

}  // namespace eyrie::mesh
