// SPDX-License-Identifier: Apache-2.0
#include "fabric/flight.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::fabric {
namespace {

/// What is interpolated of a camera.
struct State {
    Vec3 eye;
    Vec3 target;
    Vec3 up;
    double fovYDegrees = 0;
};

State stateOf(const Camera& camera) {
    return {camera.eye, camera.target, camera.up, camera.fovYDegrees};
}

/// Of one quantity at keys before, at both ends of, and after an interval of time.
template <typename T>
struct Four {
    T before, from, to, after;
};

/// How far one key is from the next, and where in between.
struct Interval {
    Four<double> times;
    double share = 0;  ///< 0 at `from`, 1 at `to`
};

template <typename T>
T hermite(const Four<T>& value, const Interval& interval) {
    const Four<double>& t = interval.times;
    const double length = t.to - t.from;
    // At the ends `before` or `after` is the end itself: the slope is then that of the interval.
    const T slopeFrom = (value.to - value.before) * (length / (t.to - t.before));
    const T slopeTo = (value.after - value.from) * (length / (t.after - t.from));
    const double s = interval.share;
    const double s2 = s * s;
    const double s3 = s2 * s;
    return value.from * (2 * s3 - 3 * s2 + 1) + slopeFrom * (s3 - 2 * s2 + s) +
           value.to * (3 * s2 - 2 * s3) + slopeTo * (s3 - s2);
}

}  // namespace

Camera Flight::at(double seconds) const {
    const double time = keys.front().seconds + seconds;
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), time,
                         [](double value, const FlightKey& key) { return value < key.seconds; });
    if (next == keys.begin())
        return keys.front().camera;
    if (next == keys.end())
        return keys.back().camera;
    const auto from = next - 1;
    if (time == from->seconds)
        return from->camera;
    const auto before = from == keys.begin() ? from : from - 1;
    const auto after = next + 1 == keys.end() ? next : next + 1;
    const Interval interval{{before->seconds, from->seconds, next->seconds, after->seconds},
                            (time - from->seconds) / (next->seconds - from->seconds)};
    const Four<State> states{stateOf(before->camera), stateOf(from->camera), stateOf(next->camera),
                             stateOf(after->camera)};
    const auto curve = [&]<typename Part>(Part State::*part) {
        return hermite(
            Four<Part>{states.before.*part, states.from.*part, states.to.*part, states.after.*part},
            interval);
    };
    return {curve(&State::eye), curve(&State::target), curve(&State::up),
            std::clamp(curve(&State::fovYDegrees), kMinFovYDegrees, kMaxFovYDegrees)};
}

absl::Status validate(const Flight& flight) {
    if (flight.keys.empty())
        return absl::InvalidArgumentError("the flight has no keys; give at least one camera");
    for (std::size_t i = 0; i < flight.keys.size(); ++i) {
        const FlightKey& key = flight.keys[i];
        const std::string name = fmt::format("keys[{}]", i);
        if (!std::isfinite(key.seconds))
            return absl::InvalidArgumentError(name + ".seconds is not a finite number");
        if (std::abs(key.seconds) > kMaxFlightSeconds)
            return absl::InvalidArgumentError(
                fmt::format("{}.seconds is {}; it must be from {:g} to {:g}", name, key.seconds,
                            -kMaxFlightSeconds, kMaxFlightSeconds));
        if (i != 0 && key.seconds <= flight.keys[i - 1].seconds)
            return absl::InvalidArgumentError(
                fmt::format("{}.seconds is {}, not after the {} of the key before", name,
                            key.seconds, flight.keys[i - 1].seconds));
        if (const absl::Status status = validate(key.camera); !status.ok())
            return withContext(status, name);
    }
    return absl::OkStatus();
}

}  // namespace eyrie::fabric
