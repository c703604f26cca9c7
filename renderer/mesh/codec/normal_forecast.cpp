// SPDX-License-Identifier: Apache-2.0
// Weights by angle: G. Thürmer, C. Wüthrich, "Computing Vertex Normals from Polygonal Facets",
// 1998. The arc cosine: M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 1964,
// 4.4.46.
#include "renderer/mesh/codec/normal_forecast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fabric/simd_clones.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr std::size_t kBlock = 256;  ///< triangles at a time
constexpr float kTiny = 1e-30F;      ///< keeps quotients finite

using Lane = std::array<float, kBlock>;

/// A block of triangles: corners in, unit normals and angles out.
struct Block {
    std::array<std::array<Lane, 3>, 3> corner;  ///< by corner, then axis
    std::array<Lane, 3> normal;
    std::array<Lane, 3> angle;  ///< by corner
};

/// Within 2e-8 for exact arithmetic, of a cosine.
inline float arcCosine(float cosine) {
    const float x = std::abs(cosine);
    float sum = -0.0012624911F;
    sum = sum * x + 0.0066700901F;
    sum = sum * x - 0.0170881256F;
    sum = sum * x + 0.0308918810F;
    sum = sum * x - 0.0501743046F;
    sum = sum * x + 0.0889789874F;
    sum = sum * x - 0.2145988016F;
    sum = sum * x + 1.5707963050F;
    const float angle = std::sqrt(x < 1 ? 1 - x : 0.0F) * sum;
    return cosine < 0 ? 3.14159265F - angle : angle;
}

inline float atLeastTiny(float value) { return value > kTiny ? value : kTiny; }

/// Differences of lattice coordinates are exact in float.
EYRIE_SIMD_CLONES void measure(Block& block) {
    for (std::size_t i = 0; i < kBlock; ++i) {
        std::array<std::array<float, 3>, 3> side{};  // from a corner to the next
        std::array<float, 3> length{};
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                side[k][axis] = block.corner[(k + 1) % 3][axis][i] - block.corner[k][axis][i];
            length[k] = std::sqrt(side[k][0] * side[k][0] + side[k][1] * side[k][1] +
                                  side[k][2] * side[k][2]);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& out = side[k];
            const auto& in = side[(k + 2) % 3];
            const float cosine = -(out[0] * in[0] + out[1] * in[1] + out[2] * in[2]) /
                                 atLeastTiny(length[k] * length[(k + 2) % 3]);
            block.angle[k][i] = arcCosine(cosine);
        }
        const float x = side[0][1] * side[1][2] - side[0][2] * side[1][1];
        const float y = side[0][2] * side[1][0] - side[0][0] * side[1][2];
        const float z = side[0][0] * side[1][1] - side[0][1] * side[1][0];
        const float norm = atLeastTiny(std::sqrt(x * x + y * y + z * z));
        block.normal[0][i] = x / norm;
        block.normal[1][i] = y / norm;
        block.normal[2][i] = z / norm;
    }
}

/// Half away from zero, as packNormal rounds.
inline std::int32_t snorm(float value) {
    const float scaled = value * 32767;
    return static_cast<std::int32_t>(scaled + (scaled < 0 ? -0.5F : 0.5F));
}

/// packNormal in single precision; of a sum of nothing, (0, 0, 1).
EYRIE_SIMD_CLONES void pack(const float* x, const float* y, const float* z, std::size_t count,
                            std::uint32_t* normals) {
    for (std::size_t i = 0; i < count; ++i) {
        const float sum = std::abs(x[i]) + std::abs(y[i]) + std::abs(z[i]);
        const float inverse = 1 / atLeastTiny(sum);
        const float u = x[i] * inverse;
        const float v = y[i] * inverse;
        const float foldedU = (1 - std::abs(v)) * (u >= 0 ? 1.0F : -1.0F);
        const float foldedV = (1 - std::abs(u)) * (v >= 0 ? 1.0F : -1.0F);
        const bool isLower = z[i] < 0;
        const auto low = static_cast<std::uint32_t>(snorm(isLower ? foldedU : u));
        const auto high = static_cast<std::uint32_t>(snorm(isLower ? foldedV : v));
        normals[i] = (low & 0xFFFFU) | high << 16;
    }
}

/// Coordinate by coordinate, of all vertices.
struct Vectors {
    explicit Vectors(std::size_t count) : x(count), y(count), z(count) {}
    std::vector<float> x, y, z;
};

Vectors unpacked(std::span<const std::uint64_t> positions) {
    Vectors points(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const glm::uvec3 point = unpackPosition(positions[v]);
        points.x[v] = static_cast<float>(point.x);
        points.y[v] = static_cast<float>(point.y);
        points.z[v] = static_cast<float>(point.z);
    }
    return points;
}

}  // namespace

void forecastNormals(std::span<const std::uint64_t> positions,
                     std::span<const std::uint16_t> indices, std::span<std::uint32_t> normals) {
    const Vectors points = unpacked(positions);
    Vectors sums(positions.size());
    Block block{};
    for (std::size_t first = 0; first < indices.size(); first += 3 * kBlock) {
        const std::size_t count = std::min(kBlock, (indices.size() - first) / 3);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t v = indices[first + 3 * i + k];
                block.corner[k][0][i] = points.x[v];
                block.corner[k][1][i] = points.y[v];
                block.corner[k][2][i] = points.z[v];
            }
        measure(block);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t v = indices[first + 3 * i + k];
                sums.x[v] += block.normal[0][i] * block.angle[k][i];
                sums.y[v] += block.normal[1][i] * block.angle[k][i];
                sums.z[v] += block.normal[2][i] * block.angle[k][i];
            }
    }
    pack(sums.x.data(), sums.y.data(), sums.z.data(), normals.size(), normals.data());
}

}  // namespace eyrie::mesh
