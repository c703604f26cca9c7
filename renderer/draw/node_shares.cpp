// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/node_shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eyrie::draw {
namespace {

/// How many of so many triangles of a node come before a place in the mesh's work.
std::uint32_t trianglesBefore(double position, const fabric::Range& node, std::uint32_t all) {
    const double share = (position - node.begin) / (node.end - node.begin);
    return static_cast<std::uint32_t>(std::lround(std::clamp(share, 0.0, 1.0) * all));
}

}  // namespace

NodeShares::NodeShares(const mesh::EymFile& file, std::span<const CutNode> wanted,
                       std::span<const double> work, const CutRequest& request,
                       const NodeTest& hasBlended)
    : file_(file), range_(request.range) {
    const double total = std::accumulate(work.begin(), work.end(), 0.0);
    shares_.reserve(wanted.size());
    neededBefore_.reserve(wanted.size() + 1);
    neededBefore_.push_back(0);
    double before = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const CutNode& node = wanted[i];
        const double begin = before / total;
        before += work[i];
        const bool isBlended = hasBlended(node.node);
        const Share share{node.node,
                          file.nodes()[node.node].triangleEnd,
                          {begin, before / total},
                          node.points == 0 && !isBlended};
        shares_.push_back(share);
        const bool isNeeded = isBlended || fallsToChannel(share);
        neededBefore_.push_back(neededBefore_.back() + (isNeeded ? 1 : 0));
    }
}

bool NodeShares::fallsToChannel(const Share& share) const {
    return share.mayBeCut ? share.range.begin < range_.end && share.range.end > range_.begin
                          : range_.contains(share.range.begin);
}

double NodeShares::positionOf(const Share& share) const {
    return share.mayBeCut ? std::max(share.range.begin, range_.begin) : share.range.begin;
}

/// Of a node with nothing wanted above or below it: of one that is drawn for more tau than was
/// asked for, where all below it is out of view.
double NodeShares::positionOf(const Span& empty) const {
    return empty.first < shares_.size() ? shares_[empty.first].range.begin : std::nextafter(1.0, 0);
}

NodeShares::Span NodeShares::spanOf(const mesh::Node& node) const {
    const auto first =
        std::ranges::upper_bound(shares_, node.triangleBegin, {}, &Share::triangleEnd);
    const auto end = std::ranges::partition_point(first, shares_.end(), [&](const Share& share) {
        return file_.nodes()[share.node].triangleBegin < node.triangleEnd;
    });
    return {static_cast<std::size_t>(first - shares_.begin()),
            static_cast<std::size_t>(end - shares_.begin())};
}

bool NodeShares::isNeeded(std::uint32_t node) const {
    if (range_.isWhole())
        return true;
    const Span span = spanOf(file_.nodes()[node]);
    return span.isEmpty() ? range_.contains(positionOf(span))
                          : neededBefore_[span.end] > neededBefore_[span.first];
}

void NodeShares::keepNeeded(MeshCut& cut) const {
    if (range_.isWhole())
        return;
    for (auto* nodes : {&cut.wanted, &cut.drawn, &cut.between, &cut.above})
        std::erase_if(*nodes, [this](const CutNode& one) { return !isNeeded(one.node); });
}

NodePart NodeShares::partOf(const CutNode& drawn) const {
    const mesh::Node& node = file_.nodes()[drawn.node];
    const Span span = spanOf(node);
    NodePart part{0, 0, drawn.points > 0 ? 0 : node.indexCount / 3};
    if (span.isEmpty()) {
        part.rangePosition = positionOf(span);
        return part;
    }
    const auto begin = shares_.begin() + static_cast<std::ptrdiff_t>(span.first);
    const auto end = shares_.begin() + static_cast<std::ptrdiff_t>(span.end);
    const auto mine =
        std::find_if(begin, end, [this](const Share& one) { return fallsToChannel(one); });
    // What is blended and falls to others keeps its place.
    const Share& share = mine != end ? *mine : *begin;
    part.rangePosition = positionOf(share);
    if (share.node != drawn.node || !share.mayBeCut)
        return part;
    const std::uint32_t all = part.triangles;
    part.firstTriangle = trianglesBefore(range_.begin, share.range, all);
    part.triangles = trianglesBefore(range_.end, share.range, all) - part.firstTriangle;
    return part;
}

}  // namespace eyrie::draw
