// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/back_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "fabric/box.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

using fabric::Box;

/// Triangles a column has about, were they spread evenly.
constexpr std::size_t kTrianglesPerColumn = 2;
/// Columns that a triangle may stand in, on average, and triangles it may be compared with.
constexpr std::size_t kMostColumns = 32;
constexpr std::size_t kMostComparisons = 512;
/// In front of a triangle, in steps: rounding may have pushed thin walls through each other.
constexpr double kBefore = 2;
constexpr std::size_t kGrain = 1024;  // columns
/// Pockets of a node that are told apart.
constexpr std::size_t kMostPockets = 64;

/// A mesh's triangles, and its lids after them.
struct Surface {
    std::span<const std::uint64_t> positions;
    std::span<const Triangle> triangles;
};

using Corners = std::array<glm::ivec3, 3>;

Corners cornersOf(const Surface& mesh, const Triangle& triangle) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = glm::ivec3(unpackPosition(mesh.positions[triangle[i]]));
    return corners;
}

bool touch(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

/// Twice the area seen along z, positive where the front looks up.
std::int64_t areaAlongZ(const Corners& c) {
    return std::int64_t{c[1].x - c[0].x} * (c[2].y - c[0].y) -
           std::int64_t{c[1].y - c[0].y} * (c[2].x - c[0].x);
}

/// A triangle of a column, seen along z.
struct Standing {
    explicit Standing(const Corners& its)
        : corners(its),
          low(glm::min(glm::min(its[0], its[1]), its[2])),
          high(glm::max(glm::max(its[0], its[1]), its[2])) {}

    Corners corners;
    glm::ivec3 low;
    glm::ivec3 high;
};

/// The triangles by the columns along z that they reach into.
class Columns {
public:
    /// Nothing when it would take too long.
    static std::optional<Columns> sort(const Surface& mesh);

    std::vector<std::uint32_t> seenFromBehind() const;

private:
    explicit Columns(const Surface& mesh);
    template <typename Visit>
    void forColumns(const Corners& corners, const Visit& visit) const;
    std::size_t columnOf(int x, int y) const;
    void look(std::size_t column, std::vector<Standing>& all,
              std::vector<std::uint32_t>& found) const;

    Surface mesh_;
    glm::ivec3 low_{0};
    std::int64_t side_ = 1;  ///< of a column, in steps
    std::int64_t columnsX_ = 1;
    std::int64_t columnsY_ = 1;
    std::vector<std::uint64_t> first_;  ///< of a column's in triangles_; one more than columns
    std::vector<std::uint32_t> triangles_;
};

Columns::Columns(const Surface& mesh) : mesh_(mesh) {
    glm::ivec3 high(0);
    low_ = glm::ivec3(static_cast<int>(kMaxLatticeCoordinate));
    for (const std::uint64_t position : mesh.positions) {
        low_ = glm::min(low_, glm::ivec3(unpackPosition(position)));
        high = glm::max(high, glm::ivec3(unpackPosition(position)));
    }
    const std::int64_t width = high.x - low_.x + 1;
    const std::int64_t height = high.y - low_.y + 1;
    const double columns =
        static_cast<double>(mesh.triangles.size()) / static_cast<double>(kTrianglesPerColumn);
    side_ = static_cast<std::int64_t>(
        std::ceil(std::sqrt(static_cast<double>(width) * static_cast<double>(height) / columns)));
    side_ = std::max({side_, width >> 14, height >> 14, std::int64_t{1}});
    columnsX_ = (width + side_ - 1) / side_;
    columnsY_ = (height + side_ - 1) / side_;
}

std::size_t Columns::columnOf(int x, int y) const {
    return static_cast<std::size_t>((y - low_.y) / side_ * columnsX_ + (x - low_.x) / side_);
}

template <typename Visit>
void Columns::forColumns(const Corners& corners, const Visit& visit) const {
    const glm::ivec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
    const glm::ivec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
    const std::size_t across = columnOf(high.x, low.y) - columnOf(low.x, low.y);
    const std::size_t last = columnOf(low.x, high.y);
    for (std::size_t row = columnOf(low.x, low.y); row <= last;
         row += static_cast<std::size_t>(columnsX_))
        for (std::size_t column = row; column <= row + across; ++column) visit(column);
}

std::optional<Columns> Columns::sort(const Surface& mesh) {
    Columns columns(mesh);
    columns.first_.resize(static_cast<std::size_t>(columns.columnsX_ * columns.columnsY_) + 1, 0);
    std::uint64_t entries = 0;
    for (const Triangle& triangle : mesh.triangles) {
        const Corners corners = cornersOf(mesh, triangle);
        if (areaAlongZ(corners) == 0)
            continue;
        columns.forColumns(corners, [&](std::size_t column) {
            ++columns.first_[column];
            ++entries;
        });
        if (entries > kMostColumns * mesh.triangles.size())
            return std::nullopt;
    }
    double comparisons = 0;
    for (const std::uint64_t count : columns.first_)
        comparisons += static_cast<double>(count) * static_cast<double>(count);
    if (comparisons > static_cast<double>(kMostComparisons * mesh.triangles.size()))
        return std::nullopt;
    std::inclusive_scan(columns.first_.begin(), columns.first_.end(), columns.first_.begin());
    columns.triangles_.resize(entries);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Corners corners = cornersOf(mesh, mesh.triangles[i]);
        if (areaAlongZ(corners) != 0)
            columns.forColumns(corners, [&](std::size_t column) {
                columns.triangles_[--columns.first_[column]] = i;
            });
    }
    return columns;
}

/// Whether the line along z through `at`, in thirds of a step, crosses a triangle above `z`: 1
/// upwards out of its front, -1 into it, 0 if it does not. On an edge or a corner the line belongs
/// to one of the triangles there, so that a closed mesh winds it a whole number of times. Exact but
/// for z.
int crossingAbove(const Standing& triangle, const glm::ivec3& at, double z) {
    if (at.x < 3 * triangle.low.x || at.x > 3 * triangle.high.x || at.y < 3 * triangle.low.y ||
        at.y > 3 * triangle.high.y || triangle.high.z <= z)
        return 0;
    std::array<std::int64_t, 3> x, y;
    for (std::size_t i = 0; i < 3; ++i) {
        x[i] = std::int64_t{3} * triangle.corners[i].x - at.x;
        y[i] = std::int64_t{3} * triangle.corners[i].y - at.y;
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
        crossing += static_cast<double>(side) * triangle.corners[(i + 2) % 3].z;
    }
    return sign != 0 && crossing / sum > z ? sign : 0;
}

/// Adds those whose middle is in the column. `all` is memory to work in.
void Columns::look(std::size_t column, std::vector<Standing>& all,
                   std::vector<std::uint32_t>& found) const {
    all.clear();
    for (std::uint64_t i = first_[column]; i < first_[column + 1]; ++i)
        all.emplace_back(cornersOf(mesh_, mesh_.triangles[triangles_[i]]));
    // In thirds of a step, as the middles.
    const auto place = static_cast<std::int64_t>(column);
    const std::int64_t x = 3 * (low_.x + place % columnsX_ * side_);
    const std::int64_t y = 3 * (low_.y + place / columnsX_ * side_);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Corners& own = all[i].corners;
        const glm::ivec3 middle = own[0] + own[1] + own[2];
        if (middle.x < x || middle.x >= x + 3 * side_ || middle.y < y || middle.y >= y + 3 * side_)
            continue;
        const double z = middle.z / 3.0 + (areaAlongZ(own) > 0 ? kBefore : -kBefore);
        int winding = 0;
        for (const Standing& other : all) winding += crossingAbove(other, middle, z);
        if (winding < 0)
            found.push_back(triangles_[first_[column] + i]);
    }
}

std::vector<std::uint32_t> Columns::seenFromBehind() const {
    std::vector<std::uint32_t> all;
    std::mutex mutex;  // of all
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, first_.size() - 1, kGrain),
                              [&](const auto& part) {
                                  std::vector<Standing> standing;
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

std::optional<std::vector<std::uint32_t>> seenFromBehind(const PackedMesh& mesh, const Lids& lids) {
    if (mesh.triangles.empty())
        return std::nullopt;
    std::vector<Triangle> both;
    if (!lids.triangles.empty()) {
        both = mesh.triangles;
        both.insert(both.end(), lids.triangles.begin(), lids.triangles.end());
    }
    const std::optional<Columns> columns =
        Columns::sort({mesh.positions, both.empty() ? mesh.triangles : both});
    if (!columns)
        return std::nullopt;
    std::vector<std::uint32_t> found = columns->seenFromBehind();
    std::erase_if(found, [&](std::uint32_t i) { return i >= mesh.triangles.size(); });
    return found;
}

Box boxOf(const PackedMesh& mesh, const Triangle& triangle) {
    Box box;
    for (const std::uint32_t corner : triangle)
        box.grow(fabric::Vec3(unpackPosition(mesh.positions[corner])));
    return box;
}

void Pockets::addAll() {
    isEverywhere_ = true;
    boxes_.clear();
}

void Pockets::add(Box box) {
    if (isEverywhere_)
        return;
    for (std::size_t i = 0; i < boxes_.size();) {
        if (!touch(box.grownBy(glm::length(box.size()) + glm::length(boxes_[i].size())), boxes_[i]))
            ++i;
        else {
            box.grow(std::exchange(boxes_[i], boxes_.back()));
            boxes_.pop_back();
            i = 0;
        }
    }
    if (boxes_.size() < kMostPockets)
        boxes_.push_back(box);
    else
        nearest(box).grow(box);
}

/// That which takes the box in and grows least by it.
Box& Pockets::nearest(const Box& box) {
    const auto growth = [&](Box pocket) {
        const double before = glm::length(pocket.size());
        pocket.grow(box);
        return glm::length(pocket.size()) - before;
    };
    return *std::min_element(boxes_.begin(), boxes_.end(),
                             [&](const Box& a, const Box& b) { return growth(a) < growth(b); });
}

void Pockets::add(const Pockets& others) {
    if (others.isEverywhere_)
        addAll();
    for (const Box& box : others.boxes_) add(box);
}

bool Pockets::reach(const Box& box, double steps) const {
    return isEverywhere_ || std::any_of(boxes_.begin(), boxes_.end(), [&](const Box& pocket) {
               return touch(pocket.grownBy(steps), box);
           });
}

std::vector<Pockets> findPockets(const PackedMesh& mesh, const std::optional<Lids>& lids,
                                 const KdTree& tree) {
    std::vector<Pockets> pockets(tree.nodes.size());
    const auto behind = lids ? seenFromBehind(mesh, *lids) : std::nullopt;
    if (!behind) {
        for (Pockets& node : pockets) node.addAll();
        return pockets;
    }
    std::vector<bool> isBehind(mesh.triangles.size(), false);
    for (const std::uint32_t triangle : *behind) isBehind[triangle] = true;
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {  // children come after their parent
        const KdNode& node = tree.nodes[i];
        if (!node.isLeaf()) {
            pockets[i].add(pockets[static_cast<std::size_t>(node.left)]);
            pockets[i].add(pockets[static_cast<std::size_t>(node.right)]);
            continue;
        }
        for (std::uint64_t k = node.triangleBegin; k < node.triangleEnd; ++k)
            if (isBehind[tree.order[k]])
                pockets[i].add(boxOf(mesh, mesh.triangles[tree.order[k]]));
    }
    return pockets;
}

}  // namespace eyrie::mesh
