// SPDX-License-Identifier: Apache-2.0
#include "wire/flight.h"

#include <fmt/format.h>

#include "eyrie/v1/flight.pb.h"
#include "fabric/status.h"
#include "wire/camera.h"

namespace eyrie::wire {

absl::StatusOr<fabric::Flight> fromMessage(const v1::Flight& message) {
    fabric::Flight flight;
    for (const v1::FlightKey& key : message.keys()) {
        absl::StatusOr<fabric::Camera> camera = fromMessage(key.camera());
        if (!camera.ok())
            return fabric::withContext(camera.status(),
                                       fmt::format("keys[{}]", flight.keys.size()));
        flight.keys.push_back({key.seconds(), *camera});
    }
    RETURN_IF_ERROR(fabric::validate(flight));
    return flight;
}

}  // namespace eyrie::wire
