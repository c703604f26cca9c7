// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "fabric/box.h"
#include "fabric/flight.h"

namespace eyrie::cli::bench {

/// Once around `bounds` in 12 seconds, from 30 degrees above.
fabric::Flight orbit(const fabric::Box& bounds);

/// An S from one end of `bounds` to the other in 12 seconds, just above its highest point, looking
/// ahead and a little down.
fabric::Flight walkthrough(const fabric::Box& bounds);

/// "orbit", "walkthrough" or a flight file. Errors: those of readText and wire::flightFromJson.
absl::StatusOr<fabric::Flight> flightNamed(const std::string& name, const fabric::Box& bounds);

}  // namespace eyrie::cli::bench
