// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "cli/bench/flights.h"

namespace eyrie::cli::bench {
namespace {

constexpr double kShotSeconds = 0.5;
constexpr double kCutSeconds = 1e-9;
constexpr int kShotsOfAKind = 8;
constexpr double kTurn = 2 * std::numbers::pi;

/// A straight piece of flight.
struct Shot {
    fabric::Camera from;
    fabric::Camera to;
};

fabric::Camera between(const Shot& shot, double share) {
    fabric::Camera camera = shot.from;
    camera.eye = glm::mix(shot.from.eye, shot.to.eye, share);
    camera.target = glm::mix(shot.from.target, shot.to.target, share);
    return camera;
}

/// Keys close to both ends keep the curve straight: a key's slope is taken from its neighbours.
void add(const Shot& shot, double length, fabric::Flight& flight) {
    const double begin = static_cast<double>(flight.keys.size() / 4) * kShotSeconds;
    for (const double share : {0.0, kCutSeconds / length, 1 - kCutSeconds / length, 1.0})
        flight.keys.push_back({begin + share * length, between(shot, share)});
}

/// The data, and a length to keep away from them that is not 0 where they are flat.
struct Place {
    fabric::Box bounds;
    double reach = 0;

    /// `x` and `y` from -1 to 1 across the data, `height` above their highest point in reaches.
    fabric::Vec3 above(double x, double y, double height) const {
        const fabric::Vec3 half = 0.5 * bounds.size() + fabric::Vec3(0.01 * reach);
        return {bounds.centre().x + x * half.x, bounds.centre().y + y * half.y,
                bounds.max.z + height * reach};
    }
};

fabric::Camera looking(const fabric::Vec3& eye, const fabric::Vec3& target) {
    fabric::Camera camera;
    camera.eye = eye;
    camera.target = target;
    return camera;
}

/// Along the data, ahead and back in turn.
Shot turned(const Place& place, int index) {
    const double sense = index % 2 == 0 ? 1 : -1;
    const auto camera = [&](double share) {
        const double x = -0.8 + 1.6 * share;
        const fabric::Vec3 eye = place.above(x, 0.6 * std::sin(kTurn * share), 0.02);
        return looking(eye, eye + place.reach * fabric::Vec3(0.2 * sense, 0, -0.03));
    };
    return {camera(index / double{kShotsOfAKind}), camera((index + 1) / double{kShotsOfAKind})};
}

/// At one end of the data after another, the farthest next, looking inwards.
Shot elsewhere(const Place& place, int index) {
    constexpr std::array<std::array<double, 2>, kShotsOfAKind> kEnds = {
        {{-1, -1}, {1, 1}, {-1, 1}, {1, -1}, {0, -1}, {0, 1}, {-1, 0}, {1, 0}}};
    const auto [x, y] = kEnds.at(static_cast<std::size_t>(index));
    const fabric::Vec3 target = place.above(0.5 * x, 0.5 * y, -0.05);
    return {looking(place.above(0.9 * x, 0.9 * y, 0.03), target),
            looking(place.above(0.8 * x, 0.8 * y, 0.03), target)};
}

/// Just above the data, then all of it from far away.
Shot nearOrFar(const Place& place, int index) {
    const double azimuth = kTurn * index / kShotsOfAKind;
    const fabric::Vec3 away(std::cos(azimuth), std::sin(azimuth), 0.5);
    if (index % 2 == 1)
        return {looking(place.bounds.centre() + 5 * place.reach * away, place.bounds.centre()),
                looking(place.bounds.centre() + 4.5 * place.reach * away, place.bounds.centre())};
    const fabric::Vec3 target = place.above(0.3 * away.x, 0.3 * away.y, -0.05);
    return {looking(target + 0.1 * place.reach * away, target),
            looking(target + 0.06 * place.reach * away, target)};
}

}  // namespace

fabric::Flight worst(const fabric::Box& bounds) {
    const double length = glm::length(bounds.size());
    const Place place{bounds, length > 0 ? length : 1};
    std::vector<Shot> shots;
    for (const auto& shotOf : {turned, elsewhere, nearOrFar})
        for (int i = 0; i < kShotsOfAKind; ++i) shots.push_back(shotOf(place, i));
    fabric::Flight flight;
    // Without a cut after it the last shot ends on the half second, so that even steps meet the
    // others there, too.
    for (const Shot& shot : shots)
        add(shot, &shot == &shots.back() ? kShotSeconds : kShotSeconds - kCutSeconds, flight);
    return flight;
}

}  // namespace eyrie::cli::bench
