// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_join.h"

#include <algorithm>
#include <vector>

#include <glm/common.hpp>

#include "fabric/status.h"
#include "renderer/mesh/eym_check.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::mesh {
namespace {

constexpr std::size_t kCopyBytes = std::size_t{1} << 20;

/// Bytes of `parts` that are copied.
struct Region {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
};

class Joiner {
public:
    Joiner(const OutputFile& parts, std::span<const JoinedNode> joined)
        : parts_(parts), joined_(joined) {}

    /// Fills what is joined, of `joined[index]` and all under it.
    absl::Status add(std::size_t index);
    absl::Status write(std::uint64_t vertexCount, OutputFile& out, const std::stop_token& stop);

private:
    absl::Status addFile(std::uint64_t offset, std::uint64_t triangleBegin);
    void finishParent(std::size_t node, std::size_t left, std::size_t right);
    absl::Status copyPages(OutputFile& out, const std::stop_token& stop) const;

    const OutputFile& parts_;
    std::span<const JoinedNode> joined_;
    EymHeader header_;  ///< of the last file
    std::vector<Node> nodes_;
    std::vector<PointRange> pointRanges_;
    std::vector<Region> regions_;
    std::uint64_t pageBytes_ = 0;
    std::uint64_t triangles_ = 0;
};

/// Adds a file's nodes and pages; places of pages count from the first of all.
absl::Status Joiner::addFile(std::uint64_t offset, std::uint64_t triangleBegin) {
    RETURN_IF_ERROR(parts_.readAt(offset, std::as_writable_bytes(std::span(&header_, 1))));
    const std::size_t first = nodes_.size();
    nodes_.resize(first + header_.nodeCount);
    const std::span<Node> added = std::span(nodes_).subspan(first);
    RETURN_IF_ERROR(parts_.readAt(offset + sizeof(EymHeader), std::as_writable_bytes(added)));
    const std::size_t firstRange = pointRanges_.size();
    pointRanges_.resize(firstRange + header_.pointRangeCount);
    const std::span<PointRange> ranges = std::span(pointRanges_).subspan(firstRange);
    RETURN_IF_ERROR(
        parts_.readAt(offset + endOfMaterials(header_), std::as_writable_bytes(ranges)));
    for (PointRange& range : ranges) range.node += static_cast<std::uint32_t>(first);
    const std::uint64_t pagesBegin = endOfMaterials(header_) + ranges.size_bytes();
    for (Node& node : added) {
        if (!node.isLeaf()) {
            node.left += static_cast<std::int32_t>(first);
            node.right += static_cast<std::int32_t>(first);
        }
        node.triangleBegin += triangleBegin;
        node.triangleEnd += triangleBegin;
        if (node.pageBytes > 0)
            node.pageOffset += pageBytes_ - pagesBegin;
        if (node.exactBytes > 0)
            node.exactOffset += pageBytes_ - pagesBegin;
    }
    regions_.push_back({offset + pagesBegin, header_.fileBytes - pagesBegin});
    pageBytes_ += regions_.back().bytes;
    return absl::OkStatus();
}

absl::Status Joiner::add(std::size_t index) {
    const JoinedNode& joined = joined_[index];
    const std::size_t node = nodes_.size();
    RETURN_IF_ERROR(addFile(joined.offset, triangles_));
    if (joined.left < 0) {
        triangles_ += header_.triangleCount;
        return absl::OkStatus();
    }
    const std::size_t left = nodes_.size();
    RETURN_IF_ERROR(add(static_cast<std::size_t>(joined.left)));
    const std::size_t right = nodes_.size();
    RETURN_IF_ERROR(add(static_cast<std::size_t>(joined.right)));
    finishParent(node, left, right);
    return absl::OkStatus();
}

void Joiner::finishParent(std::size_t node, std::size_t left, std::size_t right) {
    Node& parent = nodes_[node];
    parent.left = static_cast<std::int32_t>(left);
    parent.right = static_cast<std::int32_t>(right);
    parent.triangleBegin = nodes_[left].triangleBegin;
    parent.triangleEnd = nodes_[right].triangleEnd;
    parent.boxMin = glm::min(nodes_[left].boxMin, nodes_[right].boxMin);
    parent.boxMax = glm::max(nodes_[left].boxMax, nodes_[right].boxMax);
}

absl::Status Joiner::copyPages(OutputFile& out, const std::stop_token& stop) const {
    std::vector<std::byte> bytes(kCopyBytes);
    for (const Region& region : regions_)
        for (std::uint64_t at = 0; at < region.bytes; at += kCopyBytes) {
            if (stop.stop_requested())
                return absl::CancelledError("writing was cancelled");
            const std::span<std::byte> part =
                std::span(bytes).first(std::min<std::uint64_t>(region.bytes - at, kCopyBytes));
            RETURN_IF_ERROR(parts_.readAt(region.offset + at, part));
            RETURN_IF_ERROR(out.write(part));
        }
    return absl::OkStatus();
}

absl::Status Joiner::write(std::uint64_t vertexCount, OutputFile& out,
                           const std::stop_token& stop) {
    header_.nodeCount = static_cast<std::uint32_t>(nodes_.size());
    header_.lidCount = 0;
    header_.pointRangeCount = static_cast<std::uint32_t>(pointRanges_.size());
    const std::uint64_t pagesBegin = endOfTables(header_);
    for (Node& node : nodes_) {
        node.pageOffset += node.pageBytes > 0 ? pagesBegin : 0;
        node.exactOffset += node.exactBytes > 0 ? pagesBegin : 0;
    }
    header_.lidsChecksum = contentHash(std::span<const std::byte>());
    header_.pointRangesChecksum = contentHash(std::as_bytes(std::span(pointRanges_)));
    header_.nodesChecksum = contentHash(std::as_bytes(std::span(nodes_)));
    header_.triangleCount = triangles_;
    header_.sourceVertexCount = vertexCount;
    header_.coarsestErrorMetres = nodes_.front().errorMetres;
    header_.finestErrorMetres = nodes_.back().errorMetres;
    header_.fileBytes = pagesBegin + pageBytes_;
    header_.checksum = headerChecksum(header_);
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(&header_, 1))));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(nodes_))));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(pointRanges_))));
    return copyPages(out, stop);
}

}  // namespace

absl::Status joinEym(const OutputFile& parts, std::span<const JoinedNode> nodes,
                     std::uint64_t vertexCount, OutputFile& out, const std::stop_token& stop) {
    Joiner joiner(parts, nodes);
    RETURN_IF_ERROR(joiner.add(0));
    return joiner.write(vertexCount, out, stop);
}

}  // namespace eyrie::mesh
