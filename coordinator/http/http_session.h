// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "coordinator/http/context.h"

namespace eyrie::http {

/// Answers the requests of one connection, encrypted where the context says so, until it closes or
/// becomes a WebSocket.
void openHttpSession(boost::asio::ip::tcp::socket socket, Context& context, Slot slot);

}  // namespace eyrie::http
