// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/back_columns.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <span>

#include <glm/common.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "fabric/simd_clones.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Triangles a column has about, were they spread evenly.
constexpr std::size_t kTrianglesPerColumn = 4;
/// Columns that a triangle may stand in, on average, and triangles it may be compared with.
constexpr std::size_t kMostColumns = 32;
constexpr std::size_t kMostComparisons = 512;
/// In front of a triangle, in steps: rounding may have pushed thin walls through each other.
constexpr int kBefore = 2;
constexpr std::size_t kGrain = 1024;  // columns

Corners cornersOf(const Surface& mesh, const Triangle& triangle) {
    return eyrie::mesh::cornersOf(
        {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]});
}

/// Twice the area seen along z, positive where the front looks up.
std::int64_t areaAlongZ(const Corners& c) {
    return std::int64_t{c[1].x - c[0].x} * (c[2].y - c[0].y) -
           std::int64_t{c[1].y - c[0].y} * (c[2].x - c[0].x);
}

/// The triangles of a column, seen along z, with their bounds apart, in thirds of a step: most of
/// those that are compared are told from these.
class Standing {
public:
    /// Takes `count` triangles, of which `cornersOf(i)` gives the corners.
    template <typename CornersOf>
    void take(std::size_t count, const CornersOf& cornersOf) {
        corners_.resize(count);
        for (std::vector<int>* bound : {&lowX_, &highX_, &lowY_, &highY_, &highZ_})
            bound->resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            const Corners corners = cornersOf(i);
            const glm::ivec3 low = 3 * glm::min(glm::min(corners[0], corners[1]), corners[2]);
            const glm::ivec3 high = 3 * glm::max(glm::max(corners[0], corners[1]), corners[2]);
            corners_[i] = corners;
            lowX_[i] = low.x;
            highX_[i] = high.x;
            lowY_[i] = low.y;
            highY_[i] = high.y;
            highZ_[i] = high.z;
        }
    }
    std::span<const Corners> corners() const { return corners_; }

    /// Those that may be crossed above `at`, one a byte.
    std::span<const std::uint8_t> mayCross(const glm::ivec3& at) {
        mayCross_.resize(corners_.size());
        compare(lowX_.data(), highX_.data(), lowY_.data(), highY_.data(), highZ_.data(),
                corners_.size(), at, mayCross_.data());
        return mayCross_;
    }

private:
    EYRIE_SIMD_CLONES static void compare(const int* __restrict lowX, const int* __restrict highX,
                                          const int* __restrict lowY, const int* __restrict highY,
                                          const int* __restrict highZ, std::size_t count,
                                          const glm::ivec3& at, std::uint8_t* __restrict result);

    std::vector<Corners> corners_;
    std::vector<int> lowX_, highX_, lowY_, highY_, highZ_;
    std::vector<std::uint8_t> mayCross_;
};

EYRIE_SIMD_CLONES void Standing::compare(const int* __restrict lowX, const int* __restrict highX,
                                         const int* __restrict lowY, const int* __restrict highY,
                                         const int* __restrict highZ, std::size_t count,
                                         const glm::ivec3& at, std::uint8_t* __restrict result) {
    const int x = at.x;
    const int y = at.y;
    const int z = at.z;
    for (std::size_t i = 0; i < count; ++i)
        result[i] =
            static_cast<std::uint8_t>(int{lowX[i] <= x} & int{x <= highX[i]} & int{lowY[i] <= y} &
                                      int{y <= highY[i]} & int{highZ[i] > z});
}

/// The triangles of a mesh by the columns of some rows of a grid.
class Columns {
public:
    Columns(const Surface& mesh, const ColumnGrid& grid, const RowRange& rows);

    /// One for each two triangles of a column.
    double comparisons() const;
    std::vector<std::uint32_t> seenFromBehind() const;

private:
    template <typename Visit>
    void forColumns(const Corners& corners, const Visit& visit) const;
    void look(std::size_t column, Standing& all, std::vector<std::uint32_t>& found) const;

    Surface mesh_;
    const ColumnGrid& grid_;
    RowRange rows_;
    std::vector<std::uint64_t> first_;  ///< of a column's in triangles_; one more than columns
    std::vector<std::uint32_t> triangles_;
};

template <typename Visit>
void Columns::forColumns(const Corners& corners, const Visit& visit) const {
    const auto reach = grid_.reachOf(corners);
    if (!reach)
        return;
    const std::uint32_t end = std::min(reach->lastY + 1, rows_.end);
    for (std::uint32_t y = std::max(reach->firstY, rows_.begin); y < end; ++y)
        for (std::uint32_t x = reach->firstX; x <= reach->lastX; ++x)
            visit(std::size_t{y - rows_.begin} * grid_.columnsX + x);
}

Columns::Columns(const Surface& mesh, const ColumnGrid& grid, const RowRange& rows)
    : mesh_(mesh),
      grid_(grid),
      rows_(rows),
      first_(std::size_t{rows.end - rows.begin} * grid.columnsX + 1, 0) {
    for (const Triangle& triangle : mesh.triangles)
        forColumns(cornersOf(mesh, triangle), [&](std::size_t column) { ++first_[column]; });
    std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
    triangles_.resize(first_.back());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        forColumns(cornersOf(mesh, mesh.triangles[i]),
                   [&](std::size_t column) { triangles_[--first_[column]] = i; });
}

double Columns::comparisons() const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
        const auto count = static_cast<double>(first_[i + 1] - first_[i]);
        sum += count * count;
    }
    return sum;
}

/// Whether the line along z through `at`, in thirds of a step, crosses a triangle above `z`: 1
/// upwards out of its front, -1 into it, 0 if it does not. On an edge or a corner the line belongs
/// to one of the triangles there, so that a closed mesh winds it a whole number of times. Exact but
/// for z.
int crossingAbove(const Corners& corners, const glm::ivec3& at, double z) {
    std::array<std::int64_t, 3> x, y;
    for (std::size_t i = 0; i < 3; ++i) {
        x[i] = std::int64_t{3} * corners[i].x - at.x;
        y[i] = std::int64_t{3} * corners[i].y - at.y;
    }
    int sign = 0;
    double sum = 0;
    double crossing = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::int64_t side = x[i] * y[j] - x[j] * y[i];
        if (y[i] <= 0 && y[j] > 0)
            sign += side > 0 ? 1 : 0;
        else if (y[j] <= 0 && y[i] > 0)
            sign -= side < 0 ? 1 : 0;
        sum += static_cast<double>(side);
        crossing += static_cast<double>(side) * corners[(i + 2) % 3].z;
    }
    return sign != 0 && crossing / sum > z ? sign : 0;
}

/// Adds those whose middle is in the column. `all` is memory to work in.
void Columns::look(std::size_t column, Standing& all, std::vector<std::uint32_t>& found) const {
    const std::uint32_t* here = triangles_.data() + first_[column];
    all.take(first_[column + 1] - first_[column],
             [&](std::size_t i) { return cornersOf(mesh_, mesh_.triangles[here[i]]); });
    // In thirds of a step, as the middles.
    const std::int64_t side = grid_.side;
    const std::int64_t x =
        3 * (grid_.low.x + static_cast<std::int64_t>(column % grid_.columnsX) * side);
    const std::int64_t y =
        3 * (grid_.low.y + static_cast<std::int64_t>(rows_.begin + column / grid_.columnsX) * side);
    const std::span<const Corners> corners = all.corners();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Corners& own = corners[i];
        const glm::ivec3 middle = own[0] + own[1] + own[2];
        if (middle.x < x || middle.x >= x + 3 * side || middle.y < y || middle.y >= y + 3 * side)
            continue;
        const int before = 3 * (areaAlongZ(own) > 0 ? kBefore : -kBefore);
        const glm::ivec3 at(middle.x, middle.y, middle.z + before);
        const std::span<const std::uint8_t> mayCross = all.mayCross(at);
        int winding = 0;
        for (std::size_t other = 0; other < corners.size(); ++other)
            if (mayCross[other] != 0)
                winding += crossingAbove(corners[other], middle, at.z / 3.0);
        if (winding < 0)
            found.push_back(triangles_[first_[column] + i]);
    }
}

std::vector<std::uint32_t> Columns::seenFromBehind() const {
    std::vector<std::uint32_t> all;
    std::mutex mutex;  // of all
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, first_.size() - 1, kGrain),
                              [&](const auto& part) {
                                  Standing standing;
                                  std::vector<std::uint32_t> found;
                                  for (std::size_t column = part.begin(); column != part.end();
                                       ++column)
                                      look(column, standing, found);
                                  const std::lock_guard lock(mutex);
                                  all.insert(all.end(), found.begin(), found.end());
                              });
    std::sort(all.begin(), all.end());
    return all;
}

}  // namespace

Corners cornersOf(const std::array<std::uint64_t, 3>& positions) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = glm::ivec3(unpackPosition(positions[i]));
    return corners;
}

ColumnGrid::ColumnGrid(const glm::ivec3& least, const glm::ivec3& most, std::uint64_t triangles)
    : low(least), triangleCount(triangles) {
    const std::int64_t width = most.x - low.x + 1;
    const std::int64_t height = most.y - low.y + 1;
    const double columns =
        static_cast<double>(triangles) / static_cast<double>(kTrianglesPerColumn);
    const auto even = static_cast<std::int64_t>(
        std::ceil(std::sqrt(static_cast<double>(width) * static_cast<double>(height) / columns)));
    side = static_cast<std::uint32_t>(std::max({even, width >> 14, height >> 14, std::int64_t{1}}));
    columnsX = static_cast<std::uint32_t>((width + side - 1) / side);
    rows = static_cast<std::uint32_t>((height + side - 1) / side);
}

std::optional<ColumnGrid::Reach> ColumnGrid::reachOf(const Corners& corners) const {
    if (areaAlongZ(corners) == 0)
        return std::nullopt;
    // Lattice coordinates, so all of it fits 32 bits, which are quicker to divide.
    const glm::uvec3 least(glm::min(glm::min(corners[0], corners[1]), corners[2]) - low);
    const glm::uvec3 most(glm::max(glm::max(corners[0], corners[1]), corners[2]) - low);
    return Reach{least.x / side, most.x / side, least.y / side, most.y / side};
}

bool ColumnGrid::isTooMuch(std::uint64_t entries, double comparisons) const {
    return entries > kMostColumns * triangleCount ||
           comparisons > static_cast<double>(kMostComparisons * triangleCount);
}

std::optional<std::vector<std::uint32_t>> seenFromBehind(const Surface& mesh,
                                                         const ColumnGrid& grid,
                                                         const RowRange& rows,
                                                         double& comparisons) {
    const Columns columns(mesh, grid, rows);
    comparisons += columns.comparisons();
    if (grid.isTooMuch(0, comparisons))
        return std::nullopt;
    return columns.seenFromBehind();
}

}  // namespace eyrie::mesh
