// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/reachable_address.h"

#include <string_view>

#include <fmt/format.h>

namespace eyrie::coordinator {
namespace {

/// "10.0.0.7" or "[2001:db8::7]"; empty for a peer without an address, such as a Unix socket's.
std::string hostOf(std::string_view peer) {
    constexpr std::string_view kIpv4 = "ipv4:";
    constexpr std::string_view kIpv6 = "ipv6:%5B";  // gRPC escapes the brackets
    if (peer.starts_with(kIpv4)) {
        peer.remove_prefix(kIpv4.size());
        return std::string(peer.substr(0, peer.find(':')));
    }
    if (peer.starts_with(kIpv6)) {
        peer.remove_prefix(kIpv6.size());
        return fmt::format("[{}]", peer.substr(0, peer.find("%5D")));
    }
    return {};
}

}  // namespace

std::string reachableAddress(const std::string& address, const std::string& peer) {
    for (const std::string_view wildcard : {"0.0.0.0:", "[::]:"})
        if (const std::string host = hostOf(peer); address.starts_with(wildcard) && !host.empty())
            return host + address.substr(wildcard.size() - 1);
    return address;
}

}  // namespace eyrie::coordinator
