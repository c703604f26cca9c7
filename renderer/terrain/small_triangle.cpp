// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/small_triangle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace eyrie::terrain {
namespace {

constexpr std::int32_t kSmallLeg = 8;

/// The posts around a triangle's right angle; u and v are one step along each leg.
struct Legs {
    const float* apex;
    std::ptrdiff_t u;
    std::ptrdiff_t v;
    double zApex;
    double zU;  ///< at the end of leg u
    double zV;
};

/// NaN never wins.
inline void raise(double& worst, double difference) {
    const double d = std::abs(difference);
    worst = d > worst ? d : worst;
}

/// The middle of the diagonal between two posts.
inline double middle(const float* one, const float* other) {
    return (static_cast<double>(*one) + static_cast<double>(*other)) / 2;
}

/// Legs of n posts along the axes; the hypotenuse cuts cells in half.
template <int n>
SmallDeviation withAxisLegs(const Legs& legs, double floor) {
    const auto& [apex, u, v, zApex, zU, zV] = legs;
    const double perU = (zU - zApex) / n;
    const double perV = (zV - zApex) / n;
    SmallDeviation worst{floor, floor};
    for (int a = 0; a <= n; ++a)
        for (int b = 0; b <= n - a; ++b)
            raise(worst.atPosts,
                  static_cast<double>(apex[a * u + b * v]) - (zApex + a * perU + b * perV));
    const double slope = (zV - zU) / n;
    for (int k = 0; k < n; ++k) {
        const float* post = apex + n * u + k * (v - u);
        raise(worst.atCentres, zU + slope * (k + 0.5) - middle(post - u, post + v));
    }
    return worst;
}

/// Legs of n cells' diagonals; the hypotenuse lies along an axis.
template <int n>
SmallDeviation withDiagonalLegs(const Legs& legs, double floor) {
    const auto& [apex, u, v, zApex, zU, zV] = legs;
    const std::ptrdiff_t inward = (u + v) / 2;
    const std::ptrdiff_t along = (u - v) / 2;
    const double perInward = (zU + zV - 2 * zApex) / (2 * n);
    const double perAlong = (zU - zV) / (2 * n);
    SmallDeviation worst{floor, floor};
    for (int a = 0; a <= n; ++a)
        for (int b = -a; b <= a; ++b)
            raise(worst.atPosts, static_cast<double>(apex[a * inward + b * along]) -
                                     (zApex + a * perInward + b * perAlong));
    const double slopeU = (zU - zApex) / n;
    const double slopeV = (zV - zApex) / n;
    for (int k = 0; k < n; ++k) {
        const float* onU = apex + k * u;
        const float* onV = apex + k * v;
        raise(worst.atCentres, zApex + slopeU * (k + 0.5) - middle(onU + inward, onU + along));
        raise(worst.atCentres, zApex + slopeV * (k + 0.5) - middle(onV + inward, onV - along));
    }
    return worst;
}

std::int32_t legOf(const Triangle& t) {
    return std::max(std::abs(t[1].i - t[0].i), std::abs(t[1].j - t[0].j));
}

}  // namespace

bool isSmall(const Triangle& aligned) { return legOf(aligned) <= kSmallLeg; }

SmallDeviation deviationOfSmall(const HeightPatch& patch, const Triangle& t, double floor) {
    const std::int32_t n = legOf(t);
    const auto step = [&](const Corner& end) {
        return ((end.j - t[0].j) * patch.stride + (end.i - t[0].i)) / n;
    };
    const Legs legs{
        patch.row(t[0].j) + (t[0].i - patch.i0), step(t[1]), step(t[2]), t[0].z, t[1].z, t[2].z};
    const bool isDiagonal = t[1].i != t[0].i && t[1].j != t[0].j;
    switch (n) {
        case 1:
            return isDiagonal ? withDiagonalLegs<1>(legs, floor) : withAxisLegs<1>(legs, floor);
        case 2:
            return isDiagonal ? withDiagonalLegs<2>(legs, floor) : withAxisLegs<2>(legs, floor);
        case 4:
            return isDiagonal ? withDiagonalLegs<4>(legs, floor) : withAxisLegs<4>(legs, floor);
        default:
            return isDiagonal ? withDiagonalLegs<kSmallLeg>(legs, floor)
                              : withAxisLegs<kSmallLeg>(legs, floor);
    }
}

}  // namespace eyrie::terrain
