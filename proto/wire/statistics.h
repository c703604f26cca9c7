// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/statistics.h"

namespace eyrie::v1 {
class DeviceInfo;
class FrameStatistics;
}  // namespace eyrie::v1

namespace eyrie::wire {

/// Leaves width, height and renderer out: those belong to a whole frame.
v1::FrameStatistics toMessage(const fabric::FrameStatistics& statistics);

/// InvalidArgument, naming the field, for a number that is negative or not a number.
/// tau_achieved alone may be infinite.
absl::StatusOr<fabric::FrameStatistics> fromMessage(const v1::FrameStatistics& message);

v1::DeviceInfo toMessage(const fabric::DeviceInfo& device);

/// InvalidArgument for text of more than 1024 bytes.
absl::StatusOr<fabric::DeviceInfo> fromMessage(const v1::DeviceInfo& message);

}  // namespace eyrie::wire
