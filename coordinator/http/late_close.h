// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/http/context.h"
#include "coordinator/http/stream.h"

namespace eyrie::http {

/// Closes the connection with `address` to which all has been written that is to be, of whose
/// request more may be on its way: one that is closed before that has come is reset, and the peer
/// may never see the reply. So what comes is dropped until the peer has read that and closes, for
/// headerTimeout and 256 MiB at most; meanwhile it may have to make room for another connection.
void closeOnceRead(Stream stream, const std::string& address, Context& context, Slot slot);

}  // namespace eyrie::http
