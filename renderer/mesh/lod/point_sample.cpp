// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/point_sample.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderer/mesh/lod/dart_grid.h"
#include "renderer/mesh/morton.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Points per square of the radius that darts find room for on a plane, a little more than that.
constexpr double kDensity = 0.9;
/// Of the least radius: what a candidate stands for is no farther from it.
constexpr double kCandidateReach = 0.5;
/// Times the radius that the area has room for: how many there are of this is looked at first.
constexpr double kCoarse = 4;
/// Darts of a radius in those of 1: a little more than on a plane, where the first have no edge.
constexpr double kRoom = 1.1;
/// Times a radius that was too small for the points there may be, and again.
constexpr double kWider = 1.15;
/// How far texels are apart, in least radii: in pictures about a pixel.
constexpr double kTexels = 3;
/// More, besides one for each triangle, are not looked at: a surface of needles may need any
/// number.
constexpr std::size_t kMostCandidates = std::size_t{1} << 20;
/// Half a cell's diagonal, in steps: what rounding to the lattice moves.
constexpr double kRounding = std::numbers::sqrt3 / 2;

/// A point that may go in, and the piece of a triangle around it that it stands for.
struct Candidate {
    glm::dvec3 point{0.0};
    std::uint64_t order = 0;  ///< as if drawn by lot, but the same for the same point
    std::uint32_t triangle = 0;
    glm::dvec3 weights{0.0};
};

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

class Sampler {
public:
    Sampler(const PackedMesh& mesh, const Patch& patch, const SurfaceColours& colours,
            std::size_t mostPoints)
        : mesh_(mesh), patch_(patch), colours_(colours), mostPoints_(mostPoints) {}

    std::optional<PointSample> run(double mostErrorSteps);

private:
    bool hasBlended() const;
    double area() const;
    std::array<Corner, 3> cornersOf(const Triangle& triangle) const;
    bool makeCandidates(double reach);
    double leastRadius();
    std::vector<PointPrefix> choose(double radius);
    std::size_t mostCandidates() const { return kMostCandidates + patch_.triangles.size(); }
    void add(const Corner& at, std::uint32_t triangle, double farthest);
    void addAlong(const Corner& from, const Corner& to, double width, std::uint32_t triangle,
                  double reach);
    void cut(const std::array<Corner, 3>& corners, std::uint32_t triangle, double reach);
    void putInOrder();
    bool throwDarts(double radius);
    using Chosen = std::vector<std::uint32_t>;
    void alongCurve(Chosen::iterator begin, Chosen::iterator end) const;
    std::size_t putForward(std::size_t first, double radius);
    void addPoint(const Candidate& candidate, PointSample& sample) const;
    std::uint32_t normalAt(const Triangle& triangle, const glm::dvec3& weights,
                           bool isOneSided) const;

    const PackedMesh& mesh_;
    const Patch& patch_;
    const SurfaceColours& colours_;
    const std::size_t mostPoints_;
    std::vector<Candidate> candidates_;
    Chosen chosen_;       ///< candidates, as they went in
    double reach_ = 0;    ///< of a candidate, and how far the patch is off
    double spacing_ = 0;  ///< of texels that are looked at
};

bool Sampler::hasBlended() const {
    return std::ranges::any_of(mesh_.materials, &Material::isBlended) &&
           std::ranges::any_of(patch_.triangles, [this](const Triangle& triangle) {
               return mesh_.materials[mesh_.materialOf[triangle[0]]].isBlended();
           });
}

/// The same whichever corner comes first.
std::array<Corner, 3> Sampler::cornersOf(const Triangle& triangle) const {
    std::array<Corner, 3> corners;
    std::array<std::uint64_t, 3> keys{};
    for (std::size_t k = 0; k < 3; ++k) {
        keys[k] = mesh_.positions[triangle[k]];
        corners[k].point = glm::dvec3(unpackPosition(keys[k]));
        corners[k].weights[static_cast<int>(k)] = 1;
    }
    const auto least = std::ranges::min_element(keys) - keys.begin();
    std::rotate(corners.begin(), corners.begin() + least, corners.end());
    return corners;
}

double Sampler::area() const {
    std::vector<double> areas;
    areas.reserve(patch_.triangles.size());
    for (const Triangle& triangle : patch_.triangles) {
        const auto [a, b, c] = cornersOf(triangle);
        areas.push_back(glm::length(glm::cross(b.point - a.point, c.point - a.point)) / 2);
    }
    std::sort(areas.begin(), areas.end());  // so that the sum does not depend on their order
    double sum = 0;
    for (const double one : areas) sum += one;
    return sum;
}

void Sampler::add(const Corner& at, std::uint32_t triangle, double farthest) {
    if (colours_.isThere(patch_.triangles[triangle], at.weights, spacing_))
        candidates_.push_back({at.point, lotOf(at.point), triangle, at.weights});
    reach_ = std::max(reach_, farthest + double{patch_.shifts[triangle].longest()});
}

/// Of a triangle that is hardly wider than its longest side: along that.
void Sampler::addAlong(const Corner& from, const Corner& to, double width, std::uint32_t triangle,
                       double reach) {
    const double half = std::sqrt(reach * reach - width * width);
    const double length = glm::distance(from.point, to.point);
    const double pieces = std::ceil(length / (2 * half));
    for (double i = 0.5; i < pieces && candidates_.size() <= mostCandidates(); ++i)
        add(between(from, to, i / pieces), triangle, std::hypot(length / (2 * pieces), width));
}

/// Pieces of a triangle, halved at their longest sides until all of each is within `reach` of its
/// middle, or within half of it of a side.
void Sampler::cut(const std::array<Corner, 3>& corners, std::uint32_t triangle, double reach) {
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
    if (farthest <= reach) {
        add({middle, (corners[0].weights + corners[1].weights + corners[2].weights) / 3.0},
            triangle, farthest);
        return;
    }
    const Corner& from = corners[longest];
    const Corner& to = corners[(longest + 1) % 3];
    const Corner& other = corners[(longest + 2) % 3];
    const double width =
        glm::length(glm::cross(to.point - from.point, other.point - from.point)) / length;
    if (width <= reach / 2)
        return addAlong(from, to, width, triangle, reach);
    if (candidates_.size() > mostCandidates())
        return;
    const Corner half = between(from, to, 0.5);
    cut({from, half, other}, triangle, reach);
    cut({half, to, other}, triangle, reach);
}

/// Not if these are too many.
bool Sampler::makeCandidates(double reach) {
    candidates_.clear();
    candidates_.reserve(patch_.triangles.size());
    reach_ = 0;
    for (std::uint32_t i = 0; i < patch_.triangles.size(); ++i) {
        cut(cornersOf(patch_.triangles[i]), i, reach);
        if (candidates_.size() > mostCandidates())
            return false;
    }
    putInOrder();
    return true;
}

void Sampler::putInOrder() {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(candidates_.size());
    for (const Candidate& one : candidates_)
        order.emplace_back(one.order, static_cast<std::uint32_t>(order.size()));
    // Of the same place, on the sides of two triangles, one is as good as the other.
    std::sort(order.begin(), order.end());
    std::vector<Candidate> ordered;
    ordered.reserve(order.size());
    for (const auto& [lot, index] : order) ordered.push_back(candidates_[index]);
    candidates_ = std::move(ordered);
}

/// Chooses candidates until each has one within `radius`; not if these are too many.
bool Sampler::throwDarts(double radius) {
    DartGrid grid(mostPoints_, radius);
    chosen_.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
        const glm::dvec3& point = candidates_[i].point;
        if (grid.hasNear(point))
            continue;
        if (chosen_.size() == mostPoints_)
            return false;
        grid.add(point);
        chosen_.push_back(i);
    }
    return true;
}

void Sampler::alongCurve(Chosen::iterator begin, Chosen::iterator end) const {
    std::sort(begin, end, [this](std::uint32_t a, std::uint32_t b) {
        const auto key = [this](std::uint32_t i) {
            return mortonKey(glm::uvec3(glm::round(candidates_[i].point)));
        };
        return std::pair(key(a), a) < std::pair(key(b), b);
    });
}

/// Puts chosen candidates that have none before them within `radius` before the others, beginning
/// with the `first`-th, and says how many there are before these then.
std::size_t Sampler::putForward(std::size_t first, double radius) {
    DartGrid grid(chosen_.size(), radius);
    for (std::size_t i = 0; i < first; ++i) grid.add(candidates_[chosen_[i]].point);
    const auto begin = chosen_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = std::stable_partition(begin, chosen_.end(), [&](std::uint32_t one) {
        const glm::dvec3& point = candidates_[one].point;
        const bool isFar = !grid.hasNear(point);
        if (isFar)
            grid.add(point);
        return isFar;
    });
    alongCurve(begin, end);
    return static_cast<std::size_t>(end - chosen_.begin());
}

std::uint32_t Sampler::normalAt(const Triangle& triangle, const glm::dvec3& weights,
                                bool isOneSided) const {
    const auto [a, b, c] = triangle;
    const auto point = [this](std::uint32_t v) {
        return glm::dvec3(unpackPosition(mesh_.positions[v]));
    };
    const glm::dvec3 own = glm::cross(point(b) - point(a), point(c) - point(a));
    glm::dvec3 shaded(0.0);
    for (int k = 0; k < 3; ++k)
        shaded += weights[k] *
                  glm::dvec3(unpackNormal(mesh_.normals[triangle[static_cast<std::size_t>(k)]]));
    const bool isOwn = isOneSided || glm::length(shaded) < 1e-3;
    return packNormal(glm::vec3(glm::normalize(isOwn ? own : shaded)));
}

void Sampler::addPoint(const Candidate& candidate, PointSample& sample) const {
    const Triangle& triangle = patch_.triangles[candidate.triangle];
    const Material material =
        mesh_.materials.empty() ? Material{} : mesh_.materials[mesh_.materialOf[triangle[0]]];
    sample.positions.push_back(packPosition(glm::uvec3(glm::round(candidate.point))));
    sample.normals.push_back(normalAt(triangle, candidate.weights, material.isOneSided()));
    if (!colours_.areAny())
        return;
    fabric::Rgba colour =
        colours_.at(triangle, candidate.weights, colours_.levelFor(triangle, spacing_));
    colour.a = material.isOneSided()                              ? kSeenFromFront
               : material.isTwoSided() || material.isSeeThrough() ? kSeenFromBoth
                                                                  : kSeenAsObjectHas;
    sample.colours.push_back(packColour(colour));
}

/// For about as many points as there may be. By its area a surface has room for no more; layers and
/// walls close to each other share points, so how many there are of a larger radius says how many
/// there will be.
double Sampler::leastRadius() {
    const double byArea = std::sqrt(kDensity * area() / static_cast<double>(mostPoints_));
    const double coarse = kCoarse * byArea;
    spacing_ = kTexels * coarse;
    if (!makeCandidates(coarse * kCandidateReach) || !throwDarts(coarse) || chosen_.empty())
        return byArea;
    const double share = static_cast<double>(chosen_.size()) / static_cast<double>(mostPoints_);
    return std::min(byArea, coarse * std::sqrt(kRoom * share));
}

/// As many as `radius` leaves room for, or fewer: those farthest apart first.
std::vector<PointPrefix> Sampler::choose(double radius) {
    while (!throwDarts(radius)) radius *= kWider;
    glm::dvec3 low = candidates_.front().point;
    glm::dvec3 high = low;
    for (const Candidate& one : candidates_)
        low = glm::min(low, one.point), high = glm::max(high, one.point);
    const double across = glm::distance(low, high);
    const double lost = reach_ + kRounding;
    std::vector<PointPrefix> prefixes;
    std::size_t count = 0;
    for (double next = std::exp2(std::ceil(std::log2(std::max(across / radius, 1.0)))) * radius;
         next > radius; next /= 2) {
        const std::size_t before = std::exchange(count, putForward(count, next));
        if (count == chosen_.size())
            break;
        // Each candidate has a chosen one within the radius, and that one of these within `next`.
        const PointPrefix prefix{static_cast<std::uint32_t>(count), next + radius + lost};
        if (count == before)
            prefixes.back() = prefix;
        else
            prefixes.push_back(prefix);
    }
    alongCurve(chosen_.begin() + static_cast<std::ptrdiff_t>(count), chosen_.end());
    prefixes.push_back({static_cast<std::uint32_t>(chosen_.size()), radius + lost});
    return prefixes;
}

std::optional<PointSample> Sampler::run(double mostErrorSteps) {
    if (hasBlended())
        return std::nullopt;
    // Less than a step is lost by the lattice anyway.
    double least = std::max(leastRadius(), 1.0);
    if (least * (1 + kCandidateReach) > mostErrorSteps)
        return std::nullopt;
    spacing_ = kTexels * least;
    while (!makeCandidates(least * kCandidateReach)) least *= 2;
    if (candidates_.empty())
        return std::nullopt;
    PointSample sample;
    sample.prefixes = choose(least);
    if (sample.errorSteps() > mostErrorSteps)
        return std::nullopt;
    for (const std::uint32_t one : chosen_) addPoint(candidates_[one], sample);
    return sample;
}

}  // namespace

std::optional<PointSample> samplePoints(const PackedMesh& mesh, const Patch& patch,
                                        const SurfaceColours& colours, std::size_t mostPoints,
                                        double mostErrorSteps) {
    return Sampler(mesh, patch, colours, mostPoints).run(mostErrorSteps);
}

}  // namespace eyrie::mesh
