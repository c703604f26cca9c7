// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "fabric/status.h"
#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/damaged.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lids.h"

namespace eyrie::mesh {
namespace {

constexpr float kHalfTurnDegrees = 180;

absl::Status checkCounts(const EymHeader& header) {
    if (header.lidCount > kMostLids)
        return damaged("header.lidCount", header.lidCount, fmt::format("at most {}", kMostLids));
    if (header.lightCount > fabric::kMaxLights)
        return damaged("header.lightCount", header.lightCount,
                       fmt::format("at most {}", fabric::kMaxLights));
    if (header.nodeCount == 0 || header.nodeCount > 2 * kMaxTriangles ||
        endOfTables(header) > header.fileBytes)
        return damaged("header.nodeCount", header.nodeCount, "at least 1, and room for them");
    if (header.triangleCount == 0 || header.triangleCount > kMaxTriangles)
        return damaged("header.triangleCount", header.triangleCount,
                       fmt::format("1 to {}", kMaxTriangles));
    if (header.materialCount > kMaxMaterials ||
        (header.materialCount == 0 && (header.imageCount > 0 || header.rangeCount > 0)))
        return damaged(
            "header.materialCount", header.materialCount,
            fmt::format("at most {}, and some where there are images or ranges", kMaxMaterials));
    constexpr std::uint32_t kKnown =
        kHasColours | kIsCoded | kHasExact | kExactIsFloat64 | kHasTextures | kHasCones;
    if ((header.flags & ~kKnown) != 0)
        return damaged("header.flags", header.flags, fmt::format("bits of {}", kKnown));
    return absl::OkStatus();
}

absl::Status checkErrors(const EymHeader& header) {
    if (!(std::isfinite(header.coarsestErrorMetres) && header.finestErrorMetres >= 0 &&
          header.coarsestErrorMetres >= header.finestErrorMetres))
        return damaged("header.coarsestErrorMetres", header.coarsestErrorMetres,
                       "a finite length, not below finestErrorMetres");
    const Lattice lattice{{header.originMetres[0], header.originMetres[1], header.originMetres[2]},
                          header.stepMetres};
    if (!isValid(lattice))
        return damaged(
            "header.originMetres and stepMetres",
            fmt::format("({}, {}, {}) and {}", header.originMetres[0], header.originMetres[1],
                        header.originMetres[2], header.stepMetres),
            "a whole multiple of a power of two");
    return absl::OkStatus();
}

absl::Status checkKind(std::span<const std::byte> file) {
    if (file.size() < kEymMagic.size() ||
        std::memcmp(file.data(), kEymMagic.data(), kEymMagic.size()) != 0)
        return absl::InvalidArgumentError(
            "is not an .eym mesh; make one with `eyrie import mesh FILE -o OUT.eym`");
    if (file.size() < sizeof(EymHeader))
        return damaged("header", fmt::format("{} bytes", file.size()),
                       fmt::format("{} bytes", sizeof(EymHeader)));
    return absl::OkStatus();
}

/// A node's box, or a lid's.
template <typename Boxed>
absl::Status checkBoxOf(const std::string& name, const Boxed& boxed) {
    if (glm::any(glm::greaterThan(boxed.boxMin, boxed.boxMax)) ||
        glm::any(glm::greaterThan(boxed.boxMax, glm::uvec3(kMaxLatticeCoordinate))))
        return damaged(
            name,
            fmt::format("x {} to {}, y {} to {}, z {} to {}", boxed.boxMin.x, boxed.boxMax.x,
                        boxed.boxMin.y, boxed.boxMax.y, boxed.boxMin.z, boxed.boxMax.z),
            fmt::format("ascending and at most {}", kMaxLatticeCoordinate));
    return absl::OkStatus();
}

/// Walks the table once, checking each node against itself and its parent.
class NodeCheck {
public:
    NodeCheck(const EymHeader& header, std::span<const Node> nodes)
        : header_(header), nodes_(nodes) {}

    absl::StatusOr<int> run();

private:
    struct Pending {
        std::uint32_t node;
        int level;
    };

    absl::Status checkNode(std::uint32_t index) const;
    absl::Status checkBox(std::uint32_t index) const;
    absl::Status checkPage(std::uint32_t index, std::string_view field, std::uint64_t offset,
                           std::uint64_t bytes, std::uint64_t mostBytes) const;
    absl::Status checkGeometry(std::uint32_t index) const;
    absl::Status checkChildren(std::uint32_t index) const;
    absl::Status checkInside(std::uint32_t childIndex, const Node& parent) const;

    const EymHeader& header_;
    std::span<const Node> nodes_;
};

absl::Status NodeCheck::checkBox(std::uint32_t index) const {
    const Node& node = nodes_[index];
    RETURN_IF_ERROR(checkBoxOf(fmt::format("node {}: box", index), node));
    if (!(std::isfinite(node.errorMetres) && node.errorMetres >= 0))
        return damaged(fmt::format("node {}: errorMetres", index), node.errorMetres,
                       "a finite length");
    if (!(std::isfinite(node.colourReachMetres()) && node.colourReachMetres() >= 0) ||
        (node.colourReach != 0 && (header_.flags & kHasColours) == 0))
        return damaged(fmt::format("node {}: colourReach", index), node.colourReachMetres(),
                       "a finite length; 0 without colours");
    const float most = node.isLeaf() || !node.hasGeometry() ? 0 : kHalfTurnDegrees;
    if (!(node.normalErrorDegrees >= 0 && node.normalErrorDegrees <= most))
        return damaged(fmt::format("node {}: normalErrorDegrees", index), node.normalErrorDegrees,
                       fmt::format("0 to {}", most));
    if (!(node.normalErrorMeanDegrees >= 0 &&
          node.normalErrorMeanDegrees <= node.normalErrorDegrees))
        return damaged(fmt::format("node {}: normalErrorMeanDegrees", index),
                       node.normalErrorMeanDegrees,
                       fmt::format("0 to {}, the most", node.normalErrorDegrees));
    return absl::OkStatus();
}

absl::Status NodeCheck::checkPage(std::uint32_t index, std::string_view field, std::uint64_t offset,
                                  std::uint64_t bytes, std::uint64_t mostBytes) const {
    if (bytes > mostBytes)
        return damaged(fmt::format("node {}: {}", index, field), fmt::format("{} bytes", bytes),
                       fmt::format("at most {}", mostBytes));
    if (offset < endOfTables(header_) || offset > header_.fileBytes ||
        bytes > header_.fileBytes - offset)
        return damaged(
            fmt::format("node {}: {}", index, field), fmt::format("{} bytes at {}", bytes, offset),
            fmt::format("a part of the file's {} to {}", endOfTables(header_), header_.fileBytes));
    return absl::OkStatus();
}

absl::Status NodeCheck::checkGeometry(std::uint32_t index) const {
    const Node& node = nodes_[index];
    const auto triangles = node.triangleEnd - node.triangleBegin;
    if (node.isLeaf() ? node.indexCount != 3 * triangles
                      : node.indexCount % 3 != 0 || node.indexCount > 3 * triangles)
        return damaged(fmt::format("node {}: indexCount", index), node.indexCount,
                       fmt::format("three for each of {} triangles{}", triangles,
                                   node.isLeaf() ? "" : ", or of fewer"));
    if (node.vertexCount > kMaxLeafVertices || node.indexCount > 3 * kMaxNodeTriangles ||
        (node.vertexCount == 0 && node.indexCount != 0) ||
        (node.vertexCount > node.indexCount && !node.isOfPoints()))
        return damaged(fmt::format("node {}: vertexCount and indexCount", index),
                       fmt::format("{} and {}", node.vertexCount, node.indexCount),
                       fmt::format("at most {} and {}, each vertex used, or points alone",
                                   kMaxLeafVertices, 3 * kMaxNodeTriangles));
    if (node.frontIndexCount % 3 != 0 || node.frontIndexCount > node.indexCount)
        return damaged(fmt::format("node {}: frontIndexCount", index), node.frontIndexCount,
                       fmt::format("a multiple of 3, at most {}", node.indexCount));
    if (!node.hasGeometry())
        return absl::OkStatus();
    const NodeShape shape = shapeOf(node, header_.flags);
    const std::uint64_t block = blockBytes(shape);
    const bool isCoded = (header_.flags & kIsCoded) != 0;
    RETURN_IF_ERROR(checkPage(index, "page", node.pageOffset, node.pageBytes,
                              isCoded ? mostPageBytes(shape) : block));
    if (!isCoded && (node.pageBytes != block || node.pageOffset % 8 != 0))
        return damaged(fmt::format("node {}: page", index),
                       fmt::format("{} bytes at {}", node.pageBytes, node.pageOffset),
                       fmt::format("{} at a multiple of 8", block));
    return node.isLeaf() && (header_.flags & kHasExact) != 0
               ? checkPage(index, "exact", node.exactOffset, node.exactBytes,
                           mostExactBytes(node.vertexCount))
               : absl::OkStatus();
}

absl::Status NodeCheck::checkNode(std::uint32_t index) const {
    const Node& node = nodes_[index];
    if (node.triangleBegin >= node.triangleEnd || node.triangleEnd > header_.triangleCount)
        return damaged(fmt::format("node {}: triangleBegin and triangleEnd", index),
                       fmt::format("{} and {}", node.triangleBegin, node.triangleEnd),
                       fmt::format("ascending, within {}", header_.triangleCount));
    RETURN_IF_ERROR(checkBox(index));
    RETURN_IF_ERROR(checkGeometry(index));
    return node.isLeaf() ? absl::OkStatus() : checkChildren(index);
}

absl::Status NodeCheck::checkInside(std::uint32_t childIndex, const Node& parent) const {
    const Node& child = nodes_[childIndex];
    if (glm::any(glm::lessThan(child.boxMin, parent.boxMin)) ||
        glm::any(glm::greaterThan(child.boxMax, parent.boxMax)))
        return damaged(fmt::format("node {}: box", childIndex), "one that leaves its parent's",
                       "one inside it");
    if (child.errorMetres > parent.errorMetres)
        return damaged(fmt::format("node {}: errorMetres", childIndex), child.errorMetres,
                       fmt::format("at most its parent's {}", parent.errorMetres));
    if (child.colourReachMetres() > parent.colourReachMetres())
        return damaged(fmt::format("node {}: colourReach", childIndex), child.colourReachMetres(),
                       fmt::format("at most its parent's {}", parent.colourReachMetres()));
    return absl::OkStatus();
}

absl::Status NodeCheck::checkChildren(std::uint32_t index) const {
    const Node& node = nodes_[index];
    const std::uint64_t left = static_cast<std::uint32_t>(node.left);
    const auto right = static_cast<std::int64_t>(node.right);
    if (left != std::uint64_t{index} + 1 || right <= node.left ||
        right >= static_cast<std::int64_t>(nodes_.size()))
        return damaged(fmt::format("node {}: left and right", index),
                       fmt::format("{} and {}", node.left, node.right),
                       fmt::format("{} and a later one of {} nodes", index + 1, nodes_.size()));
    const Node& a = nodes_[static_cast<std::size_t>(node.left)];
    const Node& b = nodes_[static_cast<std::size_t>(node.right)];
    if (a.triangleBegin != node.triangleBegin || a.triangleEnd != b.triangleBegin ||
        b.triangleEnd != node.triangleEnd)
        return damaged(fmt::format("node {}: its children's triangles", index),
                       fmt::format("[{}, {}) and [{}, {})", a.triangleBegin, a.triangleEnd,
                                   b.triangleBegin, b.triangleEnd),
                       fmt::format("[{}, {}) in two parts", node.triangleBegin, node.triangleEnd));
    RETURN_IF_ERROR(checkInside(static_cast<std::uint32_t>(node.left), node));
    return checkInside(static_cast<std::uint32_t>(node.right), node);
}

absl::StatusOr<int> NodeCheck::run() {
    if (nodes_[0].triangleBegin != 0 || nodes_[0].triangleEnd != header_.triangleCount)
        return damaged("node 0: triangleEnd", nodes_[0].triangleEnd, header_.triangleCount);
    int levels = 0;
    std::uint32_t next = 0;  // depth first, the tree's nodes come in the table's order
    std::vector<Pending> stack = {{0, 1}};
    while (!stack.empty()) {
        const Pending at = stack.back();
        stack.pop_back();
        if (at.node != next++)
            return damaged("node table", fmt::format("node {} as {}th", at.node, next),
                           "each node once, depth first");
        if (at.level > kMaxTreeDepth)
            return damaged(fmt::format("node {}: level", at.node), at.level,
                           fmt::format("at most {}", kMaxTreeDepth));
        RETURN_IF_ERROR(checkNode(at.node));
        levels = std::max(levels, at.level);
        const Node& node = nodes_[at.node];
        if (node.isLeaf())
            continue;
        stack.push_back({static_cast<std::uint32_t>(node.right), at.level + 1});
        stack.push_back({static_cast<std::uint32_t>(node.left), at.level + 1});
    }
    if (next != nodes_.size())
        return damaged("header.nodeCount", nodes_.size(), fmt::format("{}, the tree's", next));
    return levels;
}

/// `before` is the one before it of the same node, if there is one.
absl::Status checkPointRange(std::size_t index, const Node& node, const PointRange& range,
                             const PointRange* before) {
    const bool isNext = before == nullptr ||
                        (range.points > before->points && range.errorMetres <= before->errorMetres);
    if (isNext && range.points > 0 && range.points <= node.vertexCount &&
        std::isfinite(range.errorMetres) && range.errorMetres >= 0)
        return absl::OkStatus();
    return damaged(fmt::format("point range {}: points and errorMetres", index),
                   fmt::format("{} and {}", range.points, range.errorMetres),
                   fmt::format("1 to {}, ascending, and a length, descending", node.vertexCount));
}

}  // namespace

absl::Status checkPointRanges(std::span<const Node> nodes, std::span<const PointRange> ranges) {
    std::size_t at = 0;
    for (std::uint32_t index = 0; index < nodes.size(); ++index) {
        const Node& node = nodes[index];
        const PointRange* last = nullptr;
        for (; node.isOfPoints() && at < ranges.size() && ranges[at].node == index; ++at) {
            RETURN_IF_ERROR(checkPointRange(at, node, ranges[at], last));
            last = &ranges[at];
        }
        if (node.isOfPoints() && (last == nullptr || last->points != node.vertexCount ||
                                  last->errorMetres != node.errorMetres))
            return damaged(
                fmt::format("node {}: its point ranges", index),
                last == nullptr
                    ? "none"
                    : fmt::format("{} points within {}", last->points, last->errorMetres),
                fmt::format("all {} points, within {}", node.vertexCount, node.errorMetres));
    }
    if (at != ranges.size())
        return damaged(fmt::format("point range {}: node", at), ranges[at].node,
                       "a node of points, ascending");
    return absl::OkStatus();
}

absl::Status checkLights(std::span<const Light> lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const double away =
            glm::length(fabric::Vec3(light.place[0], light.place[1], light.place[2]));
        if (!(away <= fabric::kMaxCoordinateMetres) || (light.isDistant() && away == 0))
            return damaged(
                fmt::format("light {}: place", i),
                fmt::format("({}, {}, {})", light.place[0], light.place[1], light.place[2]),
                "a place on the lattice's scale, or a direction");
        const auto isColour = [](float c) { return c >= 0 && std::isfinite(c); };
        if (!std::ranges::all_of(light.colour, isColour))
            return damaged(
                fmt::format("light {}: colour", i),
                fmt::format("({}, {}, {})", light.colour[0], light.colour[1], light.colour[2]),
                "three numbers, 0 or more");
        if (!light.isDistant() && !(light.reachMetres >= fabric::kLeastReachMetres &&
                                    light.reachMetres <= fabric::kMostReachMetres))
            return damaged(
                fmt::format("light {}: reachMetres", i), light.reachMetres,
                fmt::format("0, or {} to {}", fabric::kLeastReachMetres, fabric::kMostReachMetres));
    }
    return absl::OkStatus();
}

absl::Status checkCones(std::span<const Light> lights, std::span<const Cone> cones) {
    for (std::size_t i = 0; i < cones.size(); ++i) {
        const Cone& cone = cones[i];
        if (!cone.isSpot())
            continue;
        if (lights[i].isDistant())
            return damaged(fmt::format("cone {}: outerDegrees", i), cone.outerDegrees,
                           "0 of a distant light");
        const double length = glm::length(fabric::Vec3(cone.axis[0], cone.axis[1], cone.axis[2]));
        if (!(length > 0 && std::isfinite(length)))
            return damaged(fmt::format("cone {}: axis", i),
                           fmt::format("({}, {}, {})", cone.axis[0], cone.axis[1], cone.axis[2]),
                           "a direction");
        if (!(cone.outerDegrees > 0 && cone.outerDegrees <= 90 && cone.innerDegrees >= 0 &&
              cone.innerDegrees <= cone.outerDegrees))
            return damaged(fmt::format("cone {}: innerDegrees and outerDegrees", i),
                           fmt::format("{} and {}", cone.innerDegrees, cone.outerDegrees),
                           "angles up to 90, the inner one no more than the outer one");
    }
    return absl::OkStatus();
}

std::uint64_t endOfTables(const EymHeader& header) {
    return endOfPointRanges(header) + header.lightCount * sizeof(Light) +
           coneCount(header) * sizeof(Cone);
}

absl::Status checkHeader(std::span<const std::byte> beginning, std::uint64_t fileBytes) {
    RETURN_IF_ERROR(checkKind(beginning));
    EymHeader header;
    std::memcpy(&header, beginning.data(), sizeof header);
    if (header.version != kEymVersion)
        return absl::InvalidArgumentError(
            fmt::format("header.version is {}, this build reads {}; import the mesh again with "
                        "this build",
                        header.version, kEymVersion));
    if (header.headerBytes != sizeof(EymHeader))
        return damaged("header.headerBytes", header.headerBytes, sizeof(EymHeader));
    if (header.fileBytes != fileBytes)
        return damaged("header.fileBytes", header.fileBytes,
                       fmt::format("the file's {}", fileBytes));
    if (headerChecksum(header) != header.checksum)
        return absl::DataLossError(
            "the checksum of the header does not match; import the mesh again");
    RETURN_IF_ERROR(checkCounts(header));
    return checkErrors(header);
}

absl::StatusOr<int> checkNodes(const EymHeader& header, std::span<const Node> nodes) {
    return NodeCheck(header, nodes).run();
}

absl::Status checkLids(std::span<const Lid> lids) {
    for (std::size_t i = 0; i < lids.size(); ++i)
        RETURN_IF_ERROR(checkBoxOf(fmt::format("lid {}: box", i), lids[i]));
    return absl::OkStatus();
}

}  // namespace eyrie::mesh
