// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <absl/status/status.h>

#include "fabric/camera.h"

namespace eyrie::fabric {

/// Where a flight's camera is at a time.
struct FlightKey {
    double seconds = 0;
    Camera camera;

    bool operator==(const FlightKey&) const = default;
};

/// A key's time is between this and its negative: lengths, and times between keys, stay numbers.
inline constexpr double kMaxFlightSeconds = 1e15;

/// A camera's path. Between keys eye, target, up and field of view follow cubic Hermite curves that
/// pass through the keys, with the slopes of Catmull and Rom, "A class of local interpolating
/// splines" (1974), for keys unevenly spaced in time.
struct Flight {
    std::vector<FlightKey> keys;

    /// From the first key to the last. Precondition: validate(flight) is ok.
    double seconds() const { return keys.back().seconds - keys.front().seconds; }

    /// `seconds` after the first key; before it and after the last one, the camera of that key.
    /// Precondition: validate(flight) is ok. A curve may lead through cameras that
    /// fabric::validate refuses, where eye and target meet between keys.
    Camera at(double seconds) const;
};

/// InvalidArgument, naming the key, when there are no keys, their times are not finite, beyond
/// kMaxFlightSeconds or do not ascend, or a camera is refused.
absl::Status validate(const Flight& flight);

}  // namespace eyrie::fabric
