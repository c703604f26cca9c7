// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/look.h"

namespace eyrie::v1 {
class Look;
}

namespace eyrie::wire {

v1::Look toMessage(const fabric::Look& look);

/// InvalidArgument, naming the field, unless fabric::validate accepts it.
absl::StatusOr<fabric::Look> fromMessage(const v1::Look& message);

}  // namespace eyrie::wire
