// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace eyrie::coordinator {

/// Where to reach a renderer that says it listens at `address` and whose call came from `peer`, in
/// gRPC's form ("ipv4:10.0.0.7:41234", "ipv6:%5B2001:db8::7%5D:41234"). A renderer that listens on
/// every interface ("0.0.0.0:5000", "[::]:5000") does not know which of its addresses is seen from
/// here; the peer's is. Every other address is returned as it is.
std::string reachableAddress(const std::string& address, const std::string& peer);

}  // namespace eyrie::coordinator
