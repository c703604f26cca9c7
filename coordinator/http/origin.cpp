// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/origin.h"

#include <algorithm>
#include <string>

#include <boost/asio/ip/address.hpp>

namespace eyrie::http {
namespace {

std::string lowerCase(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    return result;
}

/// "localhost" of "localhost:8080"; "::1" of "[::1]:8080".
std::string_view hostName(std::string_view host) {
    if (!host.empty() && host.front() == '[')
        return host.substr(1, host.find(']') - 1);
    return host.substr(0, host.find(':'));
}

bool isAddressOrLocalhost(std::string_view name) {
    boost::system::error_code error;
    boost::asio::ip::make_address(std::string(name), error);
    return !error || lowerCase(name) == "localhost";
}

}  // namespace

bool isAllowedOrigin(std::string_view origin, std::string_view host, bool localNamesOnly) {
    if (localNamesOnly && !isAddressOrLocalhost(hostName(host)))
        return false;
    if (origin.empty())
        return true;
    const std::string wanted = lowerCase(host);
    const std::string found = lowerCase(origin);
    return !wanted.empty() && (found == "http://" + wanted || found == "https://" + wanted);
}

}  // namespace eyrie::http
