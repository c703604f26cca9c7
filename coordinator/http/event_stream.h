// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <boost/beast/http/message.hpp>

#include "coordinator/api/message_stream.h"
#include "coordinator/http/context.h"
#include "coordinator/http/stream.h"

namespace eyrie::http {

/// Answers a request with server-sent events, one for each message, until the client goes, takes
/// nothing for writeTimeout, or there are no more. `head` is what the answer begins with. Between
/// messages a comment now and then keeps proxies from closing the connection. Lives as long as the
/// connection.
void openEventStream(Stream stream, const boost::beast::http::response_header<>& head,
                     std::shared_ptr<api::MessageStream> messages, Context& context, Slot slot);

}  // namespace eyrie::http
