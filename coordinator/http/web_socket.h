// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/http/context.h"
#include "coordinator/http/stream.h"
#include "coordinator/stream/sessions.h"

namespace eyrie::http {

/// Makes a viewer of a connection, in the session that it asks for. `received` is what came over it
/// so far: the request for the upgrade and what followed. Lives as long as the connection.
void openWebSocket(Stream stream, std::string received, const stream::Joining& joining,
                   Context& context, Slot slot);

}  // namespace eyrie::http
