// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/flights.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "cli/scene_files.h"
#include "fabric/status.h"
#include "wire/json.h"

namespace eyrie::cli::bench {
namespace {

constexpr double kSeconds = 12;
constexpr int kIntervals = 48;
constexpr double kTurn = 2 * std::numbers::pi;

/// The camera that `at` gives for each of kIntervals + 1 shares of the flight.
template <typename CameraAt>
fabric::Flight sampled(const CameraAt& at) {
    fabric::Flight flight;
    for (int i = 0; i <= kIntervals; ++i) {
        const double share = static_cast<double>(i) / kIntervals;
        flight.keys.push_back({kSeconds * share, at(share)});
    }
    return flight;
}

}  // namespace

fabric::Flight orbit(const fabric::Box& bounds) {
    const double radius = 0.75 * glm::length(bounds.size());
    const double elevation = kTurn / 12;
    return sampled([&](double share) {
        const double azimuth = kTurn * share;
        fabric::Camera camera;
        camera.target = bounds.centre();
        camera.eye = camera.target + radius * fabric::Vec3(std::cos(azimuth) * std::cos(elevation),
                                                           std::sin(azimuth) * std::cos(elevation),
                                                           std::sin(elevation));
        return camera;
    });
}

fabric::Flight walkthrough(const fabric::Box& bounds) {
    const fabric::Vec3 size = bounds.size();
    const auto place = [&](double share) {
        return bounds.min + fabric::Vec3(size.x * (0.1 + 0.8 * share),
                                         size.y * (0.5 + 0.3 * std::sin(kTurn * share)),
                                         size.z + 0.02 * size.x);
    };
    return sampled([&](double share) {
        fabric::Camera camera;
        camera.eye = place(share);
        camera.target = place(share + 0.05) - fabric::Vec3(0, 0, 0.03 * size.x);
        return camera;
    });
}

absl::StatusOr<fabric::Flight> flightNamed(const std::string& name, const fabric::Box& bounds) {
    if (name == "orbit")
        return orbit(bounds);
    if (name == "walkthrough")
        return walkthrough(bounds);
    ASSIGN_OR_RETURN(const std::string text, readText(name));
    return wire::flightFromJson(text, name);
}

}  // namespace eyrie::cli::bench
