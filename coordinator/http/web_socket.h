// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "access/tokens.h"
#include "coordinator/http/context.h"
#include "coordinator/http/stream.h"

namespace eyrie::http {

/// Makes a viewer of a connection, who may do what `role` may. `received` is what came over it so
/// far: the request for the upgrade and what followed. Lives as long as the connection.
void openWebSocket(Stream stream, std::string received, access::Role role, Context& context,
                   Slot slot);

}  // namespace eyrie::http
