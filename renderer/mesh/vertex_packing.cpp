// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/vertex_packing.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace eyrie::mesh {
namespace {

constexpr double kSnormScale = 32767;

double awayFromZero(double sign) { return sign >= 0 ? 1.0 : -1.0; }

std::uint32_t snorm16(double value) {
    const auto rounded = static_cast<std::int16_t>(std::lround(value * kSnormScale));
    return static_cast<std::uint16_t>(rounded);
}

double fromSnorm16(std::uint32_t bits) {
    return std::max(static_cast<std::int16_t>(bits & 0xFFFFU) / kSnormScale, -1.0);
}

}  // namespace

std::uint32_t packNormal(const glm::vec3& normal) {
    const glm::dvec3 n(normal);
    const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    double u = n.x / sum;
    double v = n.y / sum;
    if (n.z < 0) {  // the lower half folds over the diagonals of the square
        const double folded = (1 - std::abs(v)) * awayFromZero(u);
        v = (1 - std::abs(u)) * awayFromZero(v);
        u = folded;
    }
    return snorm16(u) | snorm16(v) << 16;
}

glm::vec3 unpackNormal(std::uint32_t packed) {
    const double u = fromSnorm16(packed);
    const double v = fromSnorm16(packed >> 16);
    glm::dvec3 n(u, v, 1 - std::abs(u) - std::abs(v));
    if (n.z < 0) {
        n.x = (1 - std::abs(v)) * awayFromZero(u);
        n.y = (1 - std::abs(u)) * awayFromZero(v);
    }
    return glm::vec3(glm::normalize(n));
}

}  // namespace eyrie::mesh
