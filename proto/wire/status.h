// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

namespace grpc {
class Status;
}

namespace eyrie::wire {

/// The same code and message on the other side: absl::StatusCode has gRPC's numbers.
/// Data have the names in it that anybody may see (fabric::shownName), since others read it there.
/// A message longer than 4 KiB is cut, for it travels in an HTTP header.
grpc::Status toGrpc(const absl::Status& status);

/// `peer` ("renderer unix:/run/r0") goes before the message, where there is one.
absl::Status fromGrpc(const grpc::Status& status, const std::string& peer);

}  // namespace eyrie::wire
