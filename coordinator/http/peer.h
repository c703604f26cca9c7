// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <boost/asio/ip/tcp.hpp>

/// Who is at the other end of a connection, and what the system holds for them.
namespace eyrie::http {

/// An IP address; of IPv6 the network, since who has one address has all of it.
std::string addressOf(const boost::asio::ip::tcp::socket& socket);

/// Whether nothing more than what lies there will come.
bool hasHungUp(int socket);

/// The system says that it has room for more only when a third of what it holds, of up to some
/// megabytes, has gone: over a slow link that takes longer than a reader has. So it is not given
/// much more than it can send.
void limitUnsent(int socket);

}  // namespace eyrie::http
