// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "coordinator/frame/frame_source.h"
#include "fabric/vec.h"

namespace eyrie::test {

/// Cameras around and close above what lies in `bounds`, the same ones in every run.
inline std::vector<coordinator::FrameRequest> randomViews(const fabric::Box& bounds, int count) {
    constexpr unsigned kSeed = 20261121;
    std::mt19937 random(kSeed);
    const auto in = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<coordinator::FrameRequest> views(static_cast<std::size_t>(count));
    for (coordinator::FrameRequest& view : views) {
        const fabric::Vec3 size = bounds.size();
        view.camera.target =
            bounds.min + size * fabric::Vec3(in(0.2, 0.8), in(0.2, 0.8), in(0.2, 0.8));
        const double azimuth = in(0, 2 * M_PI);
        const double height = in(0.1, 1.2);
        view.camera.eye = view.camera.target +
                          glm::length(size) * in(0.15, 1.2) *
                              fabric::Vec3(std::cos(azimuth) * std::cos(height),
                                           std::sin(azimuth) * std::cos(height), std::sin(height));
        view.camera.fovYDegrees = in(20, 80);
    }
    return views;
}

}  // namespace eyrie::test
