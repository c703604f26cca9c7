// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/orient.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <oneapi/tbb/parallel_sort.h>

#include "fabric/vec.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::import {
namespace {

using fabric::Vec3;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The largest share of a surface that its holes may have, as discs of their length, for the
/// surface to enclose a volume.
constexpr double kLargestHole = 0.1;

/// A side of a triangle.
struct Side {
    std::uint32_t low;  ///< its points
    std::uint32_t high;
    std::uint32_t at;  ///< 3 * triangle + the corner it begins at
    bool isForward;    ///< from low to high

    bool operator<(const Side& other) const {
        return std::pair(low, high) != std::pair(other.low, other.high)
                   ? std::pair(low, high) < std::pair(other.low, other.high)
                   : at < other.at;
    }
};

class Orienter {
public:
    Orienter(std::span<const std::uint64_t> positions, std::span<const mesh::Triangle> triangles)
        : positions_(positions),
          triangles_(triangles),
          turned_(triangles.size(), false),
          isSeen_(triangles.size(), false) {
        link();
    }

    std::vector<bool> run(OrientCounts& counts) {
        for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
            if (isSeen_[i])
                continue;
            gather(i, counts);
            ++counts.components;
            if (isTurnedWhole(counts))
                for (const std::uint32_t triangle : component_)
                    turned_[triangle] = !turned_[triangle];
        }
        counts.turnedTriangles +=
            static_cast<std::uint64_t>(std::count(turned_.begin(), turned_.end(), true));
        return std::move(turned_);
    }

private:
    void link();
    void gather(std::uint32_t first, OrientCounts& counts);
    bool isTurnedWhole(OrientCounts& counts) const;
    double volume(const Vec3& from) const;

    Vec3 position(std::uint32_t point) const {
        return Vec3(mesh::unpackPosition(positions_[point]));
    }

    std::span<const std::uint64_t> positions_;
    std::span<const mesh::Triangle> triangles_;
    std::vector<std::uint32_t> across_;  ///< per side, that of the one neighbour; kNone without
    std::vector<bool> agrees_;           ///< per side, whether both wind the same way
    std::vector<bool> turned_;
    std::vector<bool> isSeen_;
    std::vector<std::uint32_t> component_;  ///< the one being looked at
    bool isContrary_ = false;
};

void Orienter::link() {
    std::vector<Side> sides;
    sides.reserve(triangles_.size() * 3);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t from = triangles_[i][corner];
            const std::uint32_t to = triangles_[i][(corner + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), 3 * i + corner, from < to});
        }
    oneapi::tbb::parallel_sort(sides.begin(), sides.end());
    across_.assign(sides.size(), kNone);
    agrees_.assign(sides.size(), false);
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        while (end < sides.size() && sides[end].low == sides[begin].low &&
               sides[end].high == sides[begin].high)
            ++end;
        if (end - begin != 2)
            continue;
        const Side& a = sides[begin];
        const Side& b = sides[begin + 1];
        across_[a.at] = b.at;
        across_[b.at] = a.at;
        agrees_[a.at] = agrees_[b.at] = a.isForward != b.isForward;
    }
}

/// Fills component_, its triangles turned as the first one is.
void Orienter::gather(std::uint32_t first, OrientCounts& counts) {
    component_.assign(1, first);
    isSeen_[first] = true;
    std::uint64_t contrary = 0;  // each is met from both sides
    for (std::size_t i = 0; i < component_.size(); ++i) {
        const std::uint32_t triangle = component_[i];
        for (std::uint32_t side = 3 * triangle; side < 3 * triangle + 3; ++side) {
            if (across_[side] == kNone)
                continue;
            const std::uint32_t other = across_[side] / 3;
            const bool turned = turned_[triangle] == agrees_[side];
            if (isSeen_[other]) {
                contrary += turned_[other] != turned ? 1 : 0;
                continue;
            }
            isSeen_[other] = true;
            turned_[other] = turned;
            component_.push_back(other);
        }
    }
    isContrary_ = contrary > 0;
    counts.contraryEdges += contrary / 2;
}

/// Six times what the component encloses with the cone of its border to `from`.
double Orienter::volume(const Vec3& from) const {
    double sum = 0;
    for (const std::uint32_t i : component_) {
        const auto [a, b, c] = triangles_[i];
        const double part =
            glm::dot(position(a) - from, glm::cross(position(b) - from, position(c) - from));
        sum += turned_[i] ? -part : part;
    }
    return sum;
}

bool Orienter::isTurnedWhole(OrientCounts& counts) const {
    double area = 0, kept = 0, borderLength = 0;
    Vec3 borderSum(0.0);
    std::size_t borderSides = 0;
    for (const std::uint32_t i : component_) {
        const auto [a, b, c] = triangles_[i];
        const double own =
            glm::length(glm::cross(position(b) - position(a), position(c) - position(a))) / 2;
        area += own;
        kept += turned_[i] ? 0 : own;
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            if (across_[3 * i + corner] != kNone)
                continue;
            const Vec3 from = position(triangles_[i][corner]);
            const Vec3 to = position(triangles_[i][(corner + 1) % 3]);
            borderLength += glm::length(to - from);
            borderSum += (from + to) / 2.0;
            ++borderSides;
        }
    }
    counts.closedComponents += borderSides == 0 && !isContrary_ ? 1 : 0;
    const double holes = borderLength * borderLength / (4 * std::numbers::pi);
    if (!isContrary_ && holes <= kLargestHole * area) {
        const double enclosed =
            volume(borderSides == 0 ? position(triangles_[component_.front()][0])
                                    : borderSum / static_cast<double>(borderSides));
        if (enclosed != 0)
            return enclosed < 0;
    }
    return kept < area / 2;
}

}  // namespace

std::vector<bool> findTurned(std::span<const std::uint64_t> positions,
                             std::span<const mesh::Triangle> triangles, OrientCounts& counts) {
    return Orienter(positions, triangles).run(counts);
}

}  // namespace eyrie::import
