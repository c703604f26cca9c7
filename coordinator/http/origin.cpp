// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/origin.h"

#include <string>

#include <absl/strings/ascii.h>
#include <boost/asio/ip/address.hpp>

namespace eyrie::http {
namespace {

/// "localhost" of "localhost:8080"; "::1" of "[::1]:8080".
std::string_view hostName(std::string_view host) {
    if (!host.empty() && host.front() == '[')
        return host.substr(1, host.find(']') - 1);
    return host.substr(0, host.find(':'));
}

bool isAddressOrLocalhost(std::string_view name) {
    boost::system::error_code error;
    boost::asio::ip::make_address(std::string(name), error);
    return !error || absl::AsciiStrToLower(std::string(name)) == "localhost";
}

}  // namespace

bool isAllowedOrigin(std::string_view origin, std::string_view host, bool localNamesOnly) {
    if (localNamesOnly && !isAddressOrLocalhost(hostName(host)))
        return false;
    if (origin.empty())
        return true;
    const std::string wanted = absl::AsciiStrToLower(std::string(host));
    const std::string found = absl::AsciiStrToLower(std::string(origin));
    return !wanted.empty() && (found == "http://" + wanted || found == "https://" + wanted);
}

}  // namespace eyrie::http
