// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace eyrie::wire {

/// Whether only this machine reaches what listens at `address`: "localhost:1", "127.0.0.1:1",
/// "[::1]:1", "unix:/path".
bool isLocal(std::string_view address);

/// Whether who calls `address` calls the machine that it is on: also "0.0.0.0:1" and "[::]:1".
bool leadsToOwnMachine(std::string_view address);

}  // namespace eyrie::wire
