// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/kd_tree.h"

#include <algorithm>
#include <memory>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include "renderer/mesh/lattice_box.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Below this many triangles a subtree is built by one thread.
constexpr std::size_t kParallelTriangles = 32768;

/// What the build sorts: three times the centroid, so that it stays an integer.
struct Item {
    glm::uvec3 centroid;
    std::uint32_t triangle;
};

struct Subtree {
    LatticeBox box;
    std::size_t begin = 0;
    std::size_t end = 0;
    std::unique_ptr<Subtree> left;
    std::unique_ptr<Subtree> right;
};

class Builder {
public:
    Builder(std::span<const std::uint64_t> positions, std::span<const Triangle> triangles,
            const KdOptions& options, const std::stop_token& stop)
        : positions_(positions),
          triangles_(triangles),
          leafTriangles_(std::max(options.leafTriangles, 1U)),
          stop_(stop),
          items_(triangles.size()) {}

    KdTree build();

private:
    void fillItems();
    std::unique_ptr<Subtree> buildSubtree(std::size_t begin, std::size_t end);
    void split(Subtree& node);
    bool fitsLeaf(std::size_t begin, std::size_t end) const;
    std::size_t countVertices(std::size_t begin, std::size_t end) const;
    LatticeBox triangleBounds(std::size_t begin, std::size_t end) const;
    std::int32_t flatten(const Subtree& subtree, std::vector<KdNode>& nodes) const;

    std::span<const std::uint64_t> positions_;
    std::span<const Triangle> triangles_;
    std::size_t leafTriangles_;
    const std::stop_token& stop_;
    std::vector<Item> items_;
};

void Builder::fillItems() {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, items_.size(), 16384),
                              [this](const auto& part) {
                                  for (std::size_t i = part.begin(); i != part.end(); ++i) {
                                      const Triangle& corners = triangles_[i];
                                      items_[i] = {unpackPosition(positions_[corners[0]]) +
                                                       unpackPosition(positions_[corners[1]]) +
                                                       unpackPosition(positions_[corners[2]]),
                                                   static_cast<std::uint32_t>(i)};
                                  }
                              });
}

std::size_t Builder::countVertices(std::size_t begin, std::size_t end) const {
    std::vector<std::uint32_t> vertices;
    vertices.reserve((end - begin) * 3);
    for (std::size_t i = begin; i < end; ++i) {
        const Triangle& corners = triangles_[items_[i].triangle];
        vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    return static_cast<std::size_t>(std::unique(vertices.begin(), vertices.end()) -
                                    vertices.begin());
}

bool Builder::fitsLeaf(std::size_t begin, std::size_t end) const {
    const std::size_t count = end - begin;
    if (count > leafTriangles_)
        return false;
    return count * 3 <= kMaxLeafVertices || countVertices(begin, end) <= kMaxLeafVertices;
}

LatticeBox Builder::triangleBounds(std::size_t begin, std::size_t end) const {
    LatticeBox box;
    for (std::size_t i = begin; i < end; ++i)
        for (const std::uint32_t corner : triangles_[items_[i].triangle])
            box.grow(unpackPosition(positions_[corner]));
    return box;
}

std::unique_ptr<Subtree> Builder::buildSubtree(std::size_t begin, std::size_t end) {
    auto node = std::make_unique<Subtree>();
    node->begin = begin;
    node->end = end;
    if (stop_.stop_requested())
        return node;
    if (fitsLeaf(begin, end))
        node->box = triangleBounds(begin, end);
    else
        split(*node);
    return node;
}

void Builder::split(Subtree& node) {
    LatticeBox centroids;
    for (std::size_t i = node.begin; i < node.end; ++i) centroids.grow(items_[i].centroid);
    const int axis = centroids.longestAxis();
    const std::size_t middle = node.begin + (node.end - node.begin) / 2;
    const auto at = [this](std::size_t i) {
        return items_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    // The index as second key makes the order total: the halves are the same sets whatever
    // nth_element does, and a heap of equal centroids still parts in the middle.
    std::nth_element(
        at(node.begin), at(middle), at(node.end), [axis](const Item& a, const Item& b) {
            return a.centroid[axis] != b.centroid[axis] ? a.centroid[axis] < b.centroid[axis]
                                                        : a.triangle < b.triangle;
        });
    const auto buildLeft = [&] { node.left = buildSubtree(node.begin, middle); };
    const auto buildRight = [&] { node.right = buildSubtree(middle, node.end); };
    if (node.end - node.begin >= kParallelTriangles) {
        oneapi::tbb::parallel_invoke(buildLeft, buildRight);
    } else {
        buildLeft();
        buildRight();
    }
    node.box = node.left->box;
    node.box.grow(node.right->box);
}

std::int32_t Builder::flatten(const Subtree& subtree, std::vector<KdNode>& nodes) const {
    const std::size_t index = nodes.size();
    KdNode node;
    node.boxMin = subtree.box.min;
    node.boxMax = subtree.box.max;
    node.triangleBegin = subtree.begin;
    node.triangleEnd = subtree.end;
    nodes.push_back(node);
    if (subtree.left) {
        const std::int32_t left = flatten(*subtree.left, nodes);
        const std::int32_t right = flatten(*subtree.right, nodes);
        nodes[index].left = left;
        nodes[index].right = right;
    }
    return static_cast<std::int32_t>(index);
}

KdTree Builder::build() {
    KdTree tree;
    if (items_.empty())
        return tree;
    fillItems();
    const std::unique_ptr<Subtree> root = buildSubtree(0, items_.size());
    flatten(*root, tree.nodes);
    tree.order.resize(items_.size());
    std::transform(items_.begin(), items_.end(), tree.order.begin(),
                   [](const Item& item) { return item.triangle; });
    // Inside a leaf nth_element's order is the library's own; ascending is everybody's.
    oneapi::tbb::parallel_for(std::size_t{0}, tree.nodes.size(), [&tree](std::size_t i) {
        const KdNode& node = tree.nodes[i];
        if (node.isLeaf())
            std::sort(tree.order.begin() + static_cast<std::ptrdiff_t>(node.triangleBegin),
                      tree.order.begin() + static_cast<std::ptrdiff_t>(node.triangleEnd));
    });
    return tree;
}

}  // namespace

absl::StatusOr<KdTree> buildKdTree(std::span<const std::uint64_t> positions,
                                   std::span<const Triangle> triangles, const KdOptions& options,
                                   const std::stop_token& stop) {
    if (triangles.size() > kMaxTriangles)
        return absl::ResourceExhaustedError(
            fmt::format("the mesh has {} triangles; at most {} fit one .eym file; split the mesh",
                        triangles.size(), kMaxTriangles));
    KdTree tree = Builder(positions, triangles, options, stop).build();
    if (stop.stop_requested())
        return absl::CancelledError("building the kd-tree was cancelled");
    return tree;
}

}  // namespace eyrie::mesh
