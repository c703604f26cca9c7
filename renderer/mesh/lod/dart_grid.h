// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace eyrie::mesh {

/// Points of which neighbours within one radius are looked up: a hash table of cells twice as wide,
/// so that a ball touches eight at most.
class DartGrid {
public:
    /// For at most `most` points.
    DartGrid(std::size_t most, double radius)
        : cell_(2 * radius), radius2_(radius * radius), heads_(slotsFor(most), kNone) {
        points_.reserve(most);
        next_.reserve(most);
    }

    void add(const glm::dvec3& point) {
        std::uint32_t& head = heads_[slotOf(glm::i64vec3(glm::floor(point / cell_)))];
        next_.push_back(head);
        head = static_cast<std::uint32_t>(points_.size());
        points_.push_back(point);
    }

    /// Whether one of them is within the radius.
    bool hasNear(const glm::dvec3& point) const {
        const glm::dvec3 place = point / cell_;
        const glm::i64vec3 own(glm::floor(place));
        const glm::i64vec3 beside =
            own + glm::i64vec3(glm::round(place - glm::dvec3(own))) * 2L - 1L;
        for (int corner = 0; corner < 8; ++corner) {  // its own cell first
            const glm::i64vec3 cell((corner & 1) != 0 ? beside.x : own.x,
                                    (corner & 2) != 0 ? beside.y : own.y,
                                    (corner & 4) != 0 ? beside.z : own.z);
            for (std::uint32_t at = heads_[slotOf(cell)]; at != kNone; at = next_[at]) {
                const glm::dvec3 way = points_[at] - point;
                if (glm::dot(way, way) <= radius2_)
                    return true;
            }
        }
        return false;
    }

private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    static std::size_t slotsFor(std::size_t most) { return std::bit_ceil(2 * most); }
    std::size_t slotOf(const glm::i64vec3& cell) const {
        const std::uint64_t hash = (static_cast<std::uint64_t>(cell.x) * 0x9E3779B97F4A7C15ULL) ^
                                   (static_cast<std::uint64_t>(cell.y) * 0xC2B2AE3D27D4EB4FULL) ^
                                   (static_cast<std::uint64_t>(cell.z) * 0x165667B19E3779F9ULL);
        return (hash ^ hash >> 32) & (heads_.size() - 1);
    }

    double cell_;
    double radius2_;
    std::vector<std::uint32_t> heads_;  ///< by slot: the last point of its cells
    std::vector<std::uint32_t> next_;   ///< by point
    std::vector<glm::dvec3> points_;
};

}  // namespace eyrie::mesh
