// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lattice.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace eyrie::mesh {
namespace {

/// Coordinates keep below this many steps, so that a double holds them and their halves exactly.
constexpr int kMaxStepBits = 52;

double largest(const fabric::Vec3& v) { return std::max({v.x, v.y, v.z}); }

/// False for not-a-number too.
bool isWithinLimit(const fabric::Box& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.min[axis] >= -kMaxCoordinateMetres && box.min[axis] <= box.max[axis] &&
              box.max[axis] <= kMaxCoordinateMetres))
            return false;
    return true;
}

/// Dividing by a power of two is exact, so the only rounding is the one to the nearest point.
double nearestStep(double metres, double step) { return std::nearbyint(metres / step); }

bool fits(const fabric::Box& box, double step, int bits) {
    for (int axis = 0; axis < 3; ++axis)
        if (nearestStep(box.max[axis], step) - nearestStep(box.min[axis], step) > (1U << bits) - 1)
            return false;
    return true;
}

}  // namespace

glm::uvec3 Lattice::nearest(const fabric::Vec3& position) const {
    glm::uvec3 point;
    for (int axis = 0; axis < 3; ++axis)
        point[axis] = static_cast<std::uint32_t>(nearestStep(position[axis], stepMetres) -
                                                 originMetres[axis] / stepMetres);
    return point;
}

fabric::Mat4 Lattice::objectFromLattice() const {
    return glm::scale(glm::translate(fabric::Mat4(1.0), originMetres), fabric::Vec3(stepMetres));
}

double Lattice::errorMetres() const { return stepMetres * (std::sqrt(3.0) / 2.0); }

absl::StatusOr<Lattice> fitLattice(const fabric::Box& bounds, int bits) {
    if (!isWithinLimit(bounds))
        return absl::InvalidArgumentError(fmt::format(
            "the vertices span x {} to {}, y {} to {}, z {} to {} m; expected finite coordinates "
            "within {} m of the origin; check the units, or translate or scale the mesh",
            bounds.min.x, bounds.max.x, bounds.min.y, bounds.max.y, bounds.min.z, bounds.max.z,
            kMaxCoordinateMetres));
    const double magnitude = largest(glm::max(glm::abs(bounds.min), glm::abs(bounds.max)));
    const double extent = largest(bounds.size());
    int exponent = kMinStepExponent;
    if (magnitude > 0)
        exponent = std::max(exponent, std::ilogb(magnitude) + 1 - kMaxStepBits);
    if (extent > 0)
        exponent = std::max(exponent, std::ilogb(extent) - bits);
    while (!fits(bounds, std::ldexp(1.0, exponent), bits)) ++exponent;
    Lattice lattice;
    lattice.stepMetres = std::ldexp(1.0, exponent);
    for (int axis = 0; axis < 3; ++axis)  // + 0.0 turns a negative zero into zero
        lattice.originMetres[axis] =
            nearestStep(bounds.min[axis], lattice.stepMetres) * lattice.stepMetres + 0.0;
    return lattice;
}

bool isValid(const Lattice& lattice) {
    int exponent = 0;
    if (!std::isfinite(lattice.stepMetres) || std::frexp(lattice.stepMetres, &exponent) != 0.5 ||
        exponent - 1 < kMinStepExponent || lattice.stepMetres > kMaxCoordinateMetres)
        return false;
    for (int axis = 0; axis < 3; ++axis) {
        const double origin = lattice.originMetres[axis];
        const double steps = origin / lattice.stepMetres;
        if (!(std::abs(origin) <= 2 * kMaxCoordinateMetres) || steps != std::nearbyint(steps) ||
            std::abs(steps) > std::ldexp(1.0, kMaxStepBits))
            return false;
    }
    return true;
}

}  // namespace eyrie::mesh
