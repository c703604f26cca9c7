// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/pick.h"

namespace eyrie::v1 {
class PickedPoint;
class PickRequest;
}  // namespace eyrie::v1

namespace eyrie::wire {

v1::PickRequest toMessage(const fabric::PickRequest& request);
/// InvalidArgument for what a camera's or sight's fromMessage or fabric::validate refuses.
absl::StatusOr<fabric::PickRequest> fromMessage(const v1::PickRequest& message);

v1::PickedPoint toMessage(const fabric::PickedPoint& point);
/// InvalidArgument, naming the field, unless its numbers are finite, but for the farthest distance,
/// and distances are in order.
absl::StatusOr<fabric::PickedPoint> fromMessage(const v1::PickedPoint& message);

}  // namespace eyrie::wire
