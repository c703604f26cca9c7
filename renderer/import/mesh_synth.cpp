// SPDX-License-Identifier: Apache-2.0
// Perlin's noise with two departures: gradients come from a 64-bit hash of lattice point and seed
// instead of a table, and they are any directions in the cube rather than twelve.
#include "renderer/import/mesh_synth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include "fabric/box.h"

namespace eyrie::import {
namespace {

using fabric::Vec3;

constexpr double kBaseFrequency = 1.7;   // bumps a radius
constexpr double kBaseAmplitude = 0.28;  // of the radius
constexpr double kMinRadius = 0.2;       // the ball never turns inside out

/// S. Vigna's splitmix64.
std::uint64_t scramble(std::uint64_t value) {
    value += 0x9E3779B97F4A7C15ULL;
    value = (value ^ value >> 30) * 0xBF58476D1CE4E5B9ULL;
    value = (value ^ value >> 27) * 0x94D049BB133111EBULL;
    return value ^ value >> 31;
}

Vec3 gradient(const Vec3& cell, std::uint64_t seed) {
    std::uint64_t bits = seed;
    for (int axis = 0; axis < 3; ++axis)
        bits = scramble(bits ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[axis])));
    const auto component = [bits](int shift) {
        return static_cast<double>(bits >> shift & 0xFFFFU) / 32767.5 - 1.0;
    };
    return {component(0), component(16), component(32)};
}

/// Noise within about -1 to 1, zero at whole numbers, twice differentiable.
double gradientNoise(const Vec3& p, std::uint64_t seed) {
    const Vec3 cell = glm::floor(p);
    const Vec3 f = p - cell;
    const Vec3 fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner((i & 1) != 0 ? 1 : 0, (i & 2) != 0 ? 1 : 0, (i & 4) != 0 ? 1 : 0);
        const Vec3 weights = glm::mix(Vec3(1.0) - fade, fade, corner);
        sum +=
            weights.x * weights.y * weights.z * glm::dot(gradient(cell + corner, seed), f - corner);
    }
    return sum;
}

double radius(const Vec3& direction, double roughness, int octaves, std::uint64_t seed) {
    double height = 0;
    double amplitude = kBaseAmplitude;
    double frequency = kBaseFrequency;
    for (int octave = 0; octave < octaves; ++octave) {
        const std::uint64_t octaveSeed = scramble(seed + static_cast<std::uint64_t>(octave));
        height += amplitude * gradientNoise(direction * frequency, octaveSeed);
        amplitude *= roughness;
        frequency *= 2;
    }
    return std::max(1.0 + height, kMinRadius);
}

/// An octahedron's faces cut into n^2 triangles each: 2n + 1 rings of vertices from pole to pole,
/// ring k having 4 min(k, 2n - k) of them, or one at a pole.
class Octasphere {
public:
    explicit Octasphere(std::uint64_t n) : n_(n) {}

    std::uint64_t rings() const { return 2 * n_ + 1; }
    std::uint64_t side(std::uint64_t ring) const { return std::min(ring, 2 * n_ - ring); }
    std::uint64_t size(std::uint64_t ring) const {
        return std::max<std::uint64_t>(4 * side(ring), 1);
    }
    std::uint64_t first(std::uint64_t ring) const {
        if (ring == 0)
            return 0;
        if (ring <= n_)
            return 1 + 2 * ring * (ring - 1);
        const std::uint64_t below = 2 * n_ - ring;  // mirrored: count from the other pole
        return vertices() - 1 - 2 * below * (below + 1);
    }
    std::uint64_t vertices() const { return 4 * n_ * n_ + 2; }

    /// Unit vector to vertex `i` of `ring`.
    Vec3 direction(std::uint64_t ring, std::uint64_t i) const {
        const auto k = static_cast<double>(side(ring));
        const double z = static_cast<double>(n_) - static_cast<double>(ring);
        if (k == 0)
            return {0, 0, z > 0 ? 1 : -1};
        const auto along = static_cast<double>(i % side(ring));
        switch (i / side(ring)) {
            case 0:
                return glm::normalize(Vec3(k - along, along, z));
            case 1:
                return glm::normalize(Vec3(-along, k - along, z));
            case 2:
                return glm::normalize(Vec3(along - k, -along, z));
            default:
                return glm::normalize(Vec3(along, along - k, z));
        }
    }

    /// Appends the triangles between `ring` and the next.
    void appendBand(std::uint64_t ring,
                    std::vector<std::array<std::uint32_t, 3>>& triangles) const {
        const bool isUpper = ring < n_;  // the ring nearer to its pole is the shorter
        const std::uint64_t shortRing = isUpper ? ring : ring + 1;
        const std::uint64_t longRing = isUpper ? ring + 1 : ring;
        const std::uint64_t k = side(shortRing);
        const auto add = [&](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
            const auto v = [](std::uint64_t i) { return static_cast<std::uint32_t>(i); };
            triangles.push_back(isUpper ? std::array{v(a), v(b), v(c)}
                                        : std::array{v(a), v(c), v(b)});
        };
        for (std::uint64_t quarter = 0; quarter < 4; ++quarter) {
            for (std::uint64_t j = 0; j <= k; ++j) {
                const std::uint64_t inner = at(shortRing, quarter * k + j);
                const std::uint64_t outer = at(longRing, quarter * (k + 1) + j);
                const std::uint64_t outerNext = at(longRing, quarter * (k + 1) + j + 1);
                add(inner, outer, outerNext);
                if (j < k)
                    add(inner, outerNext, at(shortRing, quarter * k + j + 1));
            }
        }
    }

private:
    std::uint64_t at(std::uint64_t ring, std::uint64_t i) const {
        return first(ring) + i % size(ring);
    }

    std::uint64_t n_;
};

/// The nearest floats' values. One by one through memory: where g++ 12 vectorises two neighbours'
/// way to float and back, it leaves the rounding out.
Vec3 floats(const Vec3& position) {
    Vec3 rounded;
    for (int axis = 0; axis < 3; ++axis) {
        const volatile auto value = static_cast<float>(position[axis]);
        rounded[axis] = value;
    }
    return rounded;
}

/// Adds the middles of all edges, and returns for each corner that of the edge from it to the next.
std::vector<std::array<std::uint32_t, 3>> addMiddles(TriangleMesh& mesh) {
    struct Edge {
        std::uint64_t ends;  ///< the lower in the upper half
        std::uint64_t corner;
        bool operator<(const Edge& other) const { return ends < other.ends; }
    };
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint64_t low = std::min(triangle[i], triangle[(i + 1) % 3]);
            edges.push_back(
                {low << 32 | std::max(triangle[i], triangle[(i + 1) % 3]), edges.size()});
        }
    oneapi::tbb::parallel_sort(edges.begin(), edges.end());
    std::vector<std::array<std::uint32_t, 3>> middles(mesh.triangles.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (i == 0 || edges[i].ends != edges[i - 1].ends)
            mesh.positions.push_back(floats(
                (mesh.positions[edges[i].ends >> 32] + mesh.positions[edges[i].ends & 0xFFFFFFFF]) /
                2.0));
        middles[edges[i].corner / 3][edges[i].corner % 3] =
            static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }
    return middles;
}

}  // namespace

TriangleMesh synthesizeMesh(std::uint64_t triangles, std::uint64_t seed, double roughness) {
    const auto wanted =
        static_cast<double>(std::clamp<std::uint64_t>(triangles, 8, kMaxSyntheticTriangles));
    const auto n = static_cast<std::uint64_t>(std::lround(std::sqrt(wanted / 8)));
    const Octasphere sphere(n);
    const int octaves = std::clamp(static_cast<int>(std::log2(static_cast<double>(n))), 3, 12);
    TriangleMesh mesh;
    mesh.positions.resize(sphere.vertices());
    oneapi::tbb::parallel_for(std::uint64_t{0}, sphere.rings(), [&](std::uint64_t ring) {
        for (std::uint64_t i = 0; i < sphere.size(ring); ++i) {
            const Vec3 direction = sphere.direction(ring, i);
            mesh.positions[sphere.first(ring) + i] =
                floats(direction * radius(direction, roughness, octaves, seed));
        }
    });
    mesh.triangles.reserve(8 * n * n);
    for (std::uint64_t ring = 0; ring + 1 < sphere.rings(); ++ring)
        sphere.appendBand(ring, mesh.triangles);
    return mesh;
}

absl::StatusOr<TriangleMesh> subdivide(TriangleMesh mesh, int times) {
    const std::uint64_t most = kMaxSyntheticTriangles >> 2 * std::clamp(times, 0, 31);
    if (mesh.triangles.size() > most)
        return absl::InvalidArgumentError(
            fmt::format("subdividing: found {} triangles to cut {} times, expected at most {}; cut "
                        "them fewer times",
                        mesh.triangles.size(), times, most));
    mesh.normals.clear();
    mesh.colours.clear();
    for (; times > 0; --times) {
        const auto middles = addMiddles(mesh);
        std::vector<std::array<std::uint32_t, 3>> finer;
        finer.reserve(4 * mesh.triangles.size());
        for (std::size_t i = 0; i < middles.size(); ++i) {
            const auto& [a, b, c] = mesh.triangles[i];
            const auto& [ab, bc, ca] = middles[i];
            finer.push_back({a, ab, ca});
            finer.push_back({ab, b, bc});
            finer.push_back({ca, bc, c});
            finer.push_back({ab, bc, ca});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

void displace(TriangleMesh& mesh, double metres, std::uint64_t seed) {
    constexpr double kWidest = 1.0 / 64;  // bump, of the diagonal
    constexpr int kOctaves = 5;
    fabric::Box box;
    for (const Vec3& position : mesh.positions) box.grow(position);
    const double frequency = 1 / (kWidest * glm::length(box.size()));
    if (!std::isfinite(frequency))
        return;
    mesh.normals.clear();
    oneapi::tbb::parallel_for(std::size_t{0}, mesh.positions.size(), [&](std::size_t i) {
        Vec3 way(0.0);
        for (int octave = 0; octave < kOctaves; ++octave)
            for (int axis = 0; axis < 3; ++axis)
                way[axis] +=
                    std::pow(0.5, octave + 1) *
                    gradientNoise(mesh.positions[i] * frequency * std::exp2(octave),
                                  scramble(seed + static_cast<std::uint64_t>(3 * octave + axis)));
        mesh.positions[i] = floats(mesh.positions[i] + metres * way);
    });
}

}  // namespace eyrie::import
