// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "eyrie/v1/shading.pb.h"
#include "fabric/shading.h"

namespace eyrie::wire {

v1::Shading toMessage(fabric::Shading shading);

/// InvalidArgument, naming `field`, for one that this version does not know.
absl::StatusOr<fabric::Shading> shadingFrom(v1::Shading shading, std::string_view field);

}  // namespace eyrie::wire
