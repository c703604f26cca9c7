// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/deviation.h"

namespace eyrie::terrain {

/// Which posts which level needs as vertices.
///
/// The grid, padded to a square whose side is a power of two, carries one right-triangulated
/// irregular network (Evans, Kirkpatrick, Townsend 2001; the restricted quadtree): each vertex v
/// but the first splits the two triangles whose common hypotenuse it is the midpoint of. Its error
/// is the greatest exact deviation of those two triangles from the source, and not below that of
/// the vertices that split their halves. The vertices whose error exceeds a threshold then form a
/// triangulation without T-junctions whose triangles deviate by no more than that threshold; a
/// lower threshold's vertices contain a higher one's; and since errors belong to vertices and not
/// to tiles, neighbours agree along their borders.
///
/// Posts past the last column or row stand on it (their indices are clamped). Vertices there
/// matter where their triangles reach back into the grid.
///
/// What is kept of an error is the number of thresholds that it exceeds: one byte a post.
class VertexLevels {
public:
    /// `thresholdsMetres` ascend, one a level. Parallel; reports as stage "measuring".
    /// Errors: Cancelled.
    static absl::StatusOr<VertexLevels> compute(const SourceSurface& surface,
                                                std::vector<double> thresholdsMetres,
                                                const import::ImportControl& control);

    /// Whether the error of lattice vertex (i, j) exceeds the level's threshold.
    bool isNeeded(std::int32_t i, std::int32_t j, int level) const {
        return exceeded(i, j) > level;
    }

private:
    VertexLevels(const SourceSurface& surface, std::vector<double> thresholdsMetres);

    struct Point {  ///< of the padded square
        std::int32_t i;
        std::int32_t j;
    };
    struct Found {
        std::uint64_t key;
        std::uint8_t exceeded;
    };

    int exceeded(std::int32_t i, std::int32_t j) const {
        if (i < columns_ && j < rows_) [[likely]]
            return levels_[index(i, j)];
        const auto found = outside_.find(key(i, j));
        return found == outside_.end() ? 0 : found->second;
    }
    std::size_t index(std::int32_t i, std::int32_t j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(i);
    }
    static std::uint64_t key(std::int32_t i, std::int32_t j) {
        return static_cast<std::uint64_t>(j) << 32 | static_cast<std::uint32_t>(i);
    }

    int thresholdsExceededBy(double deviationMetres) const;
    Corner corner(const Point& p) const;
    double deviation(const std::array<Point, 3>& triangle) const;
    int exceededByTriangle(const Point& p, const Point& apex, const Point& q) const;
    int exceededBySplit(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) const;
    int exceededByChildren(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) const;
    int exceededBy(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) const;
    void measureFinestRow(std::int32_t j);
    void measureClass(std::int32_t s, bool isCentre);
    void measureRow(std::int32_t j, std::int32_t s, bool isCentre, std::vector<Found>& outside);

    const SourceSurface& surface_;
    std::vector<double> thresholds_;
    std::vector<float> floatThresholds_;
    std::int32_t columns_;
    std::int32_t rows_;
    std::int32_t side_;  ///< cells a side of the padded square
    std::vector<std::uint8_t> levels_;
    std::unordered_map<std::uint64_t, std::uint8_t> outside_;
};

}  // namespace eyrie::terrain
