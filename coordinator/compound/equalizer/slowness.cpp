// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/slowness.h"

#include <algorithm>
#include <cmath>

namespace eyrie::equalizer {
namespace {

/// Of how much longer or shorter than foreseen a part took, as a logarithm.
constexpr double kOfTheChild = .1;
constexpr double kMostBelieved = .5;
constexpr double kForgotten = .02;  ///< each frame

}  // namespace

double Slowness::operator[](std::size_t child) const { return std::exp(logarithms_[child]); }

void Slowness::learn(std::span<const Measured> parts) {
    double taken = 0;
    double foreseen = 0;
    for (const Measured& part : parts) {
        taken += part.time;
        foreseen += part.foreseen * (*this)[part.child];
    }
    if (!(foreseen > 0))
        return;
    double sum = 0;
    for (const Measured& part : parts) {
        double& logarithm = logarithms_[part.child];
        const double expected = part.foreseen * std::exp(logarithm) * taken / foreseen;
        const double off = expected > 0 ? std::log(part.time / expected) : 0;
        logarithm = (1 - kForgotten) * logarithm +
                    kOfTheChild * std::clamp(off, -kMostBelieved, kMostBelieved);
        sum += logarithm;
    }
    for (const Measured& part : parts)
        logarithms_[part.child] -= sum / static_cast<double>(parts.size());
}

}  // namespace eyrie::equalizer
