// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/peer.h"

#include <algorithm>
#include <cstdint>

#include <boost/asio/ip/address.hpp>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

namespace eyrie::http {
namespace {

constexpr int kUnsentBytes = 256 * 1024;

}  // namespace

std::string addressOf(const boost::asio::ip::tcp::socket& socket) {
    boost::system::error_code error;
    const boost::asio::ip::address address = socket.remote_endpoint(error).address();
    if (error || address.is_v4())
        return error ? "nowhere" : address.to_string();
    boost::asio::ip::address_v6::bytes_type bytes = address.to_v6().to_bytes();
    if (!address.to_v6().is_v4_mapped() && !address.is_loopback())
        std::fill(bytes.begin() + 8, bytes.end(), std::uint8_t{0});
    return boost::asio::ip::address_v6(bytes).to_string();
}

bool hasHungUp(int socket) {
    pollfd asked{socket, POLLRDHUP, 0};
    return ::poll(&asked, 1, 0) > 0;
}

void limitUnsent(int socket) {
    ::setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes, sizeof(kUnsentBytes));
}

}  // namespace eyrie::http
