// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie::wire {

/// Sum of all that processes say to each other: the calls of both services, their messages, every
/// field's number and type. Two builds with the same one understand each other to the last field.
std::uint64_t protocolChecksum();

}  // namespace eyrie::wire
