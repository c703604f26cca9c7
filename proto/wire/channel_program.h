// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/channel_program.h"

namespace eyrie::v1 {
class ChannelProgram;
}

namespace eyrie::wire {

v1::ChannelProgram toMessage(const fabric::ChannelProgram& program);

/// InvalidArgument, naming the field, for what the program must not hold: areas outside of its own,
/// depth that it does not have, frames announced twice, addresses of another form, too many of
/// anything.
absl::StatusOr<fabric::ChannelProgram> fromMessage(const v1::ChannelProgram& message);

}  // namespace eyrie::wire
