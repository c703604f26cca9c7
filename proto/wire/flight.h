// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/flight.h"

namespace eyrie::v1 {
class Flight;
}

namespace eyrie::wire {

/// InvalidArgument, naming the key and field, for cameras that fromMessage refuses and what
/// fabric::validate refuses.
absl::StatusOr<fabric::Flight> fromMessage(const v1::Flight& message);

}  // namespace eyrie::wire
