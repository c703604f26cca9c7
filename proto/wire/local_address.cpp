// SPDX-License-Identifier: Apache-2.0
#include "wire/local_address.h"

#include <string>

#include <arpa/inet.h>

namespace eyrie::wire {
namespace {

std::string hostOf(std::string_view address) {
    if (address.starts_with('['))
        return std::string(address.substr(1, address.find(']') - 1));
    return std::string(address.substr(0, address.rfind(':')));
}

}  // namespace

bool isLocal(std::string_view address) {
    if (address.starts_with("unix:"))
        return true;
    const std::string host = hostOf(address);
    in_addr v4{};
    in6_addr v6{};
    if (inet_pton(AF_INET, host.c_str(), &v4) == 1)
        return ntohl(v4.s_addr) >> 24 == 127;
    if (inet_pton(AF_INET6, host.c_str(), &v6) == 1)
        return IN6_IS_ADDR_LOOPBACK(&v6);
    return host == "localhost";
}

bool leadsToOwnMachine(std::string_view address) {
    return isLocal(address) || address.starts_with("0.0.0.0:") || address.starts_with("[::]:");
}

}  // namespace eyrie::wire
