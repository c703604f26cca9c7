// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/point_sample.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <oneapi/tbb/parallel_sort.h>

#include "renderer/mesh/lod/dart_grid.h"
#include "renderer/mesh/lod/sample_pieces.h"
#include "renderer/mesh/morton.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Points per square of the radius that darts find room for on a plane, a little more than that.
constexpr double kDensity = 0.9;
/// Of the least radius: what a candidate stands for is no farther from it.
constexpr double kCandidateReach = 0.5;
/// Of the radius that the area has room for: walls and layers that share points seldom need less.
constexpr double kMostShared = 0.25;
/// Times the same: how many there are of this is looked at first.
constexpr double kCoarse = 4;
/// Darts of a radius in those of 1: a little more than on a plane, where the first have no edge.
constexpr double kRoom = 1.1;
/// Times a radius that was too small for the points there may be, and again.
constexpr double kWider = 1.15;
/// How far texels are apart, in least radii: in pictures about a pixel.
constexpr double kTexels = 3;
/// More, besides one for each triangle, are not looked at: a surface of needles may need any
/// number.
constexpr std::size_t kMostCandidates = std::size_t{1} << 18;
/// Half a cell's diagonal, in steps: what rounding to the lattice moves.
constexpr double kRounding = std::numbers::sqrt3 / 2;

class Sampler {
public:
    Sampler(const PackedMesh& mesh, const Patch& patch, const SurfaceColours& colours,
            std::size_t mostPoints)
        : mesh_(mesh), patch_(patch), colours_(colours), mostPoints_(mostPoints) {}

    std::optional<PointSample> run(double mostErrorSteps);

private:
    bool hasBlended() const;
    bool makeCandidates(double reach);
    double leastRadius(double byArea);
    std::vector<PointPrefix> choose(double radius);
    void putInOrder();
    bool throwDarts(double radius);
    using Chosen = std::vector<std::uint32_t>;
    void alongCurve(Chosen::iterator begin, Chosen::iterator end) const;
    std::size_t putForward(std::size_t first, double radius);
    void addPoint(const SamplePiece& candidate, PointSample& sample) const;
    std::uint32_t normalAt(const Triangle& triangle, const glm::dvec3& weights,
                           bool isOneSided) const;

    const PackedMesh& mesh_;
    const Patch& patch_;
    const SurfaceColours& colours_;
    const std::size_t mostPoints_;
    std::vector<SamplePiece> candidates_;
    Chosen chosen_;       ///< candidates, as they went in
    double reach_ = 0;    ///< of the candidates
    double spacing_ = 0;  ///< of texels that are looked at
};

bool Sampler::hasBlended() const {
    return std::ranges::any_of(mesh_.materials, &Material::isBlended) &&
           std::ranges::any_of(patch_.triangles, [this](const Triangle& triangle) {
               return mesh_.materials[mesh_.materialOf[triangle[0]]].isBlended();
           });
}

/// Not if these are too many.
bool Sampler::makeCandidates(double reach) {
    SamplePieces cut = cutIntoPieces(mesh_, patch_, colours_, reach, spacing_, kMostCandidates);
    candidates_ = std::move(cut.pieces);
    reach_ = cut.reachSteps;
    if (candidates_.size() > kMostCandidates + patch_.triangles.size())
        return false;
    putInOrder();
    return true;
}

void Sampler::putInOrder() {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(candidates_.size());
    for (const SamplePiece& one : candidates_)
        order.emplace_back(one.lot, static_cast<std::uint32_t>(order.size()));
    // Of the same place, on the sides of two triangles, one is as good as the other.
    oneapi::tbb::parallel_sort(order.begin(), order.end());
    std::vector<SamplePiece> ordered;
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

void Sampler::addPoint(const SamplePiece& candidate, PointSample& sample) const {
    const Triangle& triangle = patch_.triangles[candidate.triangle];
    const Material material =
        mesh_.materials.empty() ? Material{} : mesh_.materials[mesh_.materialOf[triangle[0]]];
    sample.positions.push_back(packPosition(glm::uvec3(glm::round(candidate.point))));
    sample.normals.push_back(normalAt(triangle, candidate.weights, material.isOneSided()));
    if (!colours_.areAny())
        return;
    fabric::Rgba colour =
        colours_.at(triangle, candidate.weights, colours_.levelFor(triangle, spacing_));
    colour.a = material.isOneSided() ? kSeenFromFront : kSeenFromBoth;
    sample.colours.push_back(packColour(colour));
}

/// For about as many points as there may be. By its area a surface has room for no more; layers and
/// walls close to each other share points, so how many there are of a larger radius says how many
/// there will be.
double Sampler::leastRadius(double byArea) {
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
    for (const SamplePiece& one : candidates_)
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
    const double byArea =
        std::sqrt(kDensity * areaOf(mesh_, patch_) / static_cast<double>(mostPoints_));
    const bool canSaySides =
        colours_.areAny() || std::ranges::none_of(mesh_.materials, &Material::isOneSided);
    if (kMostShared * byArea > mostErrorSteps || !canSaySides || hasBlended())
        return std::nullopt;
    // Less than a step is lost by the lattice anyway.
    double least = std::max(leastRadius(byArea), 1.0);
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
