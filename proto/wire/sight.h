// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/sight.h"

namespace eyrie::v1 {
class Sight;
}  // namespace eyrie::v1

namespace eyrie::wire {

v1::Sight toMessage(const fabric::Sight& sight);
/// InvalidArgument, naming the field, for what fabric::validate() refuses.
absl::StatusOr<fabric::Sight> fromMessage(const v1::Sight& message);

}  // namespace eyrie::wire
