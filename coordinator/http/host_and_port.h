// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace eyrie::http {

/// As in URLs and the header Host: "viz:8080", "[::1]:8080".
inline std::string hostAndPort(std::string_view host, std::uint16_t port) {
    const bool isIpv6 = host.find(':') != std::string_view::npos;
    return isIpv6 ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port);
}

}  // namespace eyrie::http
