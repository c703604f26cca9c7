// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/piece_points.h"

#include <algorithm>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace eyrie::mesh {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::size_t middleOf(std::size_t begin, std::size_t end) { return begin + (end - begin) / 2; }

int longestAxis(const glm::dvec3& size) {
    const int axis = size.y > size.x ? 1 : 0;
    return size.z > size[axis] ? 2 : axis;
}

}  // namespace

PiecePoints::PiecePoints(std::vector<PiecePoint> points)
    : points_(std::move(points)), nodes_(points_.size()) {
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) nodes_[k].point = k;
    build(0, nodes_.size());
    for (std::uint32_t k = 0; k < nodes_.size(); ++k)
        byPiece_.emplace_back(points_[nodes_[k].point].piece, k);
    std::ranges::sort(byPiece_);
}

void PiecePoints::build(std::size_t begin, std::size_t end) {
    if (begin == end)
        return;
    const std::span<Node> range(nodes_.data() + begin, end - begin);
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
    for (const Node& node : range) {
        low = glm::min(low, points_[node.point].position);
        high = glm::max(high, points_[node.point].position);
    }
    const int axis = longestAxis(high - low);
    const std::size_t middle = middleOf(begin, end);
    std::ranges::nth_element(range, range.begin() + static_cast<std::ptrdiff_t>(middle - begin), {},
                             [&](const Node& node) {
                                 return std::pair(points_[node.point].position[axis], node.point);
                             });
    nodes_[middle].axis = static_cast<std::uint8_t>(axis);
    nodes_[middle].left = static_cast<std::uint32_t>(end - begin);
    build(begin, middle);
    build(middle + 1, end);
}

const PiecePoint* PiecePoints::nearest(const glm::dvec3& at, std::uint32_t own,
                                       double reach) const {
    Found found{at, own, reach * reach, kNone};
    search(0, nodes_.size(), found);
    return found.point == kNone ? nullptr : &points_[found.point];
}

void PiecePoints::search(std::size_t begin, std::size_t end, Found& found) const {
    if (begin == end)
        return;
    const std::size_t middle = middleOf(begin, end);
    const Node& node = nodes_[middle];
    if (node.left == 0)
        return;
    const PiecePoint& point = points_[node.point];
    if (node.isThere && point.piece != found.own) {
        const glm::dvec3 away = point.position - found.at;
        const double square = glm::dot(away, away);
        if (square < found.square || (square == found.square && node.point < found.point)) {
            found.square = square;
            found.point = node.point;
        }
    }
    const double beyond = found.at[node.axis] - point.position[node.axis];
    const auto searchSide = [&](bool isHigh) {
        search(isHigh ? middle + 1 : begin, isHigh ? end : middle, found);
    };
    searchSide(beyond > 0);
    if (beyond * beyond <= found.square)
        searchSide(!(beyond > 0));
}

void PiecePoints::remove(std::uint32_t piece) {
    for (auto at = std::ranges::lower_bound(byPiece_, std::pair(piece, 0U));
         at != byPiece_.end() && at->first == piece; ++at) {
        const std::size_t gone = at->second;
        if (!nodes_[gone].isThere)
            continue;
        nodes_[gone].isThere = false;
        std::size_t begin = 0;
        std::size_t end = nodes_.size();
        for (std::size_t middle = middleOf(begin, end);; middle = middleOf(begin, end)) {
            --nodes_[middle].left;
            if (middle == gone)
                break;
            if (gone < middle)
                end = middle;
            else
                begin = middle + 1;
        }
    }
}

}  // namespace eyrie::mesh
