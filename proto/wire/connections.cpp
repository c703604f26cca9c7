// SPDX-License-Identifier: Apache-2.0
#include "wire/connections.h"

#include <array>
#include <cstdlib>
#include <memory>
#include <utility>

#include <arpa/inet.h>
#include <dirent.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace eyrie::wire {
namespace {

using Address = std::pair<std::string, std::uint16_t>;  // host, port

Address textOf(const sockaddr_storage& address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (address.ss_family == AF_INET) {
        const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
        inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
        return {text.data(), ntohs(v4.sin_port)};
    }
    if (address.ss_family != AF_INET6)
        return {};
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
    if (IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr))  // as of a port of both families
        inet_ntop(AF_INET, &v6.sin6_addr.s6_addr[12], text.data(), text.size());
    else
        inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
    return {text.data(), ntohs(v6.sin6_port)};
}

Address addressOf(int descriptor, decltype(getpeername)& ask) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (ask(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        return {};
    return textOf(address);
}

/// As linux/tcp.h has them; nothing: no TCP socket.
std::optional<int> tcpState(int descriptor) {
    tcp_info info{};
    socklen_t size = sizeof info;
    if (getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &size) != 0)
        return std::nullopt;
    return info.tcpi_state;
}

}  // namespace

Connections connectionsAt(const std::set<std::uint16_t>& ports) {
    Connections connections;
    const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/fd"), closedir);
    while (const dirent* entry = folder == nullptr ? nullptr : readdir(folder.get())) {
        const int descriptor = std::atoi(entry->d_name);
        const std::optional<int> state = tcpState(descriptor);
        if (!state || *state == TCP_LISTEN ||
            !ports.contains(addressOf(descriptor, getsockname).second))
            continue;
        const bool isOpen = *state == TCP_ESTABLISHED || *state == TCP_CLOSE_WAIT;
        connections[descriptor] = {addressOf(descriptor, getpeername).first, !isOpen};
    }
    return connections;
}

std::optional<std::string> peerOfShut(const Connections& before, const Connections& after) {
    std::set<std::string> peers;
    for (const auto& [descriptor, connection] : after) {
        if (!connection.isShut)
            continue;
        const auto earlier = before.find(descriptor);
        const bool isForgotten = connection.peer.empty() && earlier != before.end();
        peers.insert(isForgotten ? earlier->second.peer : connection.peer);
    }
    if (peers.size() != 1 || peers.begin()->empty())
        return std::nullopt;
    return *peers.begin();
}

}  // namespace eyrie::wire
