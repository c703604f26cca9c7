// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "wire/security.h"
#include "wire/transport.h"

namespace grpc {
class Server;
class Service;
}  // namespace grpc

namespace eyrie::wire {

struct Listening {
    std::unique_ptr<grpc::Server> server;
    std::vector<std::string> addresses;  ///< as given, with the ports that were chosen
};

/// Serves `services` on "host:port" (port 0: the system chooses) and "unix:/path" addresses, with
/// the limits of transport.h, but for answers, where they may be of `mostSentBytes`. They outlive
/// the server, and ask for tokens themselves (admit).
/// `withReflection`: tools may ask, without a token, which calls there are.
/// Errors: InvalidArgument (an address of another form), Unavailable (one that cannot be listened
/// on, such as a port in use).
absl::StatusOr<Listening> listen(const std::vector<std::string>& addresses,
                                 const std::vector<grpc::Service*>& services,
                                 const Security& security = {},
                                 int mostSentBytes = kMaxMessageBytes, bool withReflection = false);

/// The same for one.
absl::StatusOr<Listening> listen(const std::vector<std::string>& addresses, grpc::Service& service,
                                 const Security& security = {});

/// InvalidArgument unless `address` is "host:port" or "unix:/path".
absl::Status checkAddress(const std::string& address);

}  // namespace eyrie::wire
