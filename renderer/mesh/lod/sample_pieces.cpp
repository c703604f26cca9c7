// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/sample_pieces.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <oneapi/tbb/parallel_for.h>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Triangles that are cut at a time.
constexpr std::size_t kBlock = 8192;

struct Corner {
    glm::dvec3 point{0.0};
    glm::dvec3 weights{0.0};
};

Corner between(const Corner& from, const Corner& to, double share) {
    return {from.point + share * (to.point - from.point),
            from.weights + share * (to.weights - from.weights)};
}

std::uint64_t mixed(std::uint64_t value) {
    value = (value ^ value >> 30) * 0xBF58476D1CE4E5B9ULL;
    value = (value ^ value >> 27) * 0x94D049BB133111EBULL;
    return value ^ value >> 31;
}

std::uint64_t lotOf(const glm::dvec3& point) {
    return mixed(std::bit_cast<std::uint64_t>(point.x) +
                 mixed(std::bit_cast<std::uint64_t>(point.y) +
                       mixed(std::bit_cast<std::uint64_t>(point.z))));
}

/// The same whichever corner comes first.
std::array<Corner, 3> cornersOf(const PackedMesh& mesh, const Triangle& triangle) {
    std::array<Corner, 3> corners;
    std::array<std::uint64_t, 3> keys{};
    for (std::size_t k = 0; k < 3; ++k) {
        keys[k] = mesh.positions[triangle[k]];
        corners[k].point = glm::dvec3(unpackPosition(keys[k]));
        corners[k].weights[static_cast<int>(k)] = 1;
    }
    const auto least = std::ranges::min_element(keys) - keys.begin();
    std::rotate(corners.begin(), corners.begin() + least, corners.end());
    return corners;
}

/// Of some triangles of a patch.
class Cutter {
public:
    Cutter(const Patch& patch, const SurfaceColours& colours, double reach, double texelSteps,
           std::size_t most)
        : patch_(patch), colours_(colours), reach_(reach), texelSteps_(texelSteps), most_(most) {}

    void cut(const std::array<Corner, 3>& corners, std::uint32_t triangle);
    std::size_t count() const { return cut_.pieces.size(); }
    SamplePieces take() && { return std::move(cut_); }

private:
    bool hasTooMany() const { return count() > most_; }
    void add(const Corner& at, std::uint32_t triangle, double farthest);
    void addAlong(const Corner& from, const Corner& to, double width, std::uint32_t triangle);

    const Patch& patch_;
    const SurfaceColours& colours_;
    const double reach_;
    const double texelSteps_;
    const std::size_t most_;
    SamplePieces cut_;
};

void Cutter::add(const Corner& at, std::uint32_t triangle, double farthest) {
    if (colours_.isThere(patch_.triangles[triangle], at.weights, texelSteps_))
        cut_.pieces.push_back({at.point, lotOf(at.point), triangle, at.weights});
    cut_.reachSteps =
        std::max(cut_.reachSteps, farthest + double{patch_.shifts[triangle].longest()});
}

/// Of a triangle that is hardly wider than its longest side: along that.
void Cutter::addAlong(const Corner& from, const Corner& to, double width, std::uint32_t triangle) {
    const double half = std::sqrt(reach_ * reach_ - width * width);
    const double length = glm::distance(from.point, to.point);
    const double pieces = std::ceil(length / (2 * half));
    for (double i = 0.5; i < pieces && !hasTooMany(); ++i)
        add(between(from, to, i / pieces), triangle, std::hypot(length / (2 * pieces), width));
}

void Cutter::cut(const std::array<Corner, 3>& corners, std::uint32_t triangle) {
    const glm::dvec3 middle = (corners[0].point + corners[1].point + corners[2].point) / 3.0;
    double farthest = 0;
    std::size_t longest = 0;
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        farthest = std::max(farthest, glm::distance(corners[k].point, middle));
        const double side = glm::distance(corners[k].point, corners[(k + 1) % 3].point);
        if (side > length)
            longest = k, length = side;
    }
    if (farthest <= reach_) {
        add({middle, (corners[0].weights + corners[1].weights + corners[2].weights) / 3.0},
            triangle, farthest);
        return;
    }
    const Corner& from = corners[longest];
    const Corner& to = corners[(longest + 1) % 3];
    const Corner& other = corners[(longest + 2) % 3];
    const double width =
        glm::length(glm::cross(to.point - from.point, other.point - from.point)) / length;
    if (width <= reach_ / 2)
        return addAlong(from, to, width, triangle);
    if (hasTooMany())
        return;
    const Corner half = between(from, to, 0.5);
    cut({from, half, other}, triangle);
    cut({half, to, other}, triangle);
}

}  // namespace

SamplePieces cutIntoPieces(const PackedMesh& mesh, const Patch& patch,
                           const SurfaceColours& colours, double reachSteps, double texelSteps,
                           std::size_t most) {
    const std::size_t triangles = patch.triangles.size();
    most += triangles;
    std::atomic<std::size_t> count = 0;
    std::vector<SamplePieces> blocks((triangles + kBlock - 1) / kBlock);
    oneapi::tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
        Cutter cutter(patch, colours, reachSteps, texelSteps, most);
        const std::size_t end = std::min((block + 1) * kBlock, triangles);
        for (std::size_t i = block * kBlock; i < end && count <= most; ++i) {
            const std::size_t before = cutter.count();
            cutter.cut(cornersOf(mesh, patch.triangles[i]), static_cast<std::uint32_t>(i));
            count += cutter.count() - before;
        }
        blocks[block] = std::move(cutter).take();
    });
    SamplePieces all;
    for (SamplePieces& block : blocks) {
        all.pieces.insert(all.pieces.end(), block.pieces.begin(), block.pieces.end());
        all.reachSteps = std::max(all.reachSteps, block.reachSteps);
        block.pieces = {};
    }
    return all;
}

double areaOf(const PackedMesh& mesh, const Patch& patch) {
    std::vector<double> areas;
    areas.reserve(patch.triangles.size());
    for (const Triangle& triangle : patch.triangles) {
        const auto [a, b, c] = cornersOf(mesh, triangle);
        areas.push_back(glm::length(glm::cross(b.point - a.point, c.point - a.point)) / 2);
    }
    std::sort(areas.begin(), areas.end());  // so that the sum does not depend on their order
    double sum = 0;
    for (const double one : areas) sum += one;
    return sum;
}

}  // namespace eyrie::mesh
