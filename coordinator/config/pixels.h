// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "coordinator/config/configuration.h"
#include "fabric/viewport.h"

/// Whole pixels and parts of them.
namespace eyrie::config {

/// The pixels of a fraction; parts that meet share their edge, wherever it is rounded to, and
/// however the sum of x and width is.
inline fabric::PixelViewport part(const fabric::PixelViewport& whole, const Viewport& fraction) {
    const auto at = [](double share, std::int32_t pixels) {
        constexpr double kRounding = 1e-9;
        return static_cast<std::int32_t>(std::floor(share * pixels + .5 + kRounding));
    };
    const std::int32_t x = at(fraction.x, whole.width);
    const std::int32_t y = at(fraction.y, whole.height);
    return {whole.x + x, whole.y + y, at(fraction.x + fraction.width, whole.width) - x,
            at(fraction.y + fraction.height, whole.height) - y};
}

/// Which fraction of `whole`, which is not empty, `pixels` are.
inline Viewport fractionOf(const fabric::PixelViewport& pixels,
                           const fabric::PixelViewport& whole) {
    return {static_cast<double>(pixels.x - whole.x) / whole.width,
            static_cast<double>(pixels.y - whole.y) / whole.height,
            static_cast<double>(pixels.width) / whole.width,
            static_cast<double>(pixels.height) / whole.height};
}

/// A fraction of a fraction.
inline Viewport part(const Viewport& whole, const Viewport& fraction) {
    return {whole.x + fraction.x * whole.width, whole.y + fraction.y * whole.height,
            whole.width * fraction.width, whole.height * fraction.height};
}

/// Of a whole: what is no wider or higher is rounding, as fractions are written with few digits.
inline constexpr double kLeastFraction = 1e-6;

/// Where both are; of no width or height where nowhere.
inline Viewport intersection(const Viewport& a, const Viewport& b) {
    const double x = std::fmax(a.x, b.x);
    const double y = std::fmax(a.y, b.y);
    return {x, y, std::fmax(0, std::fmin(a.x + a.width, b.x + b.width) - x),
            std::fmax(0, std::fmin(a.y + a.height, b.y + b.height) - y)};
}

/// Whether they have more in common than what is left of rounding.
inline bool overlap(const Viewport& a, const Viewport& b) {
    const Viewport both = intersection(a, b);
    return both.width > kLeastFraction && both.height > kLeastFraction;
}

/// How `inner`, within `outer`, is a fraction of that.
inline Viewport within(const Viewport& inner, const Viewport& outer) {
    return {(inner.x - outer.x) / outer.width, (inner.y - outer.y) / outer.height,
            inner.width / outer.width, inner.height / outer.height};
}

}  // namespace eyrie::config
