// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace eyrie::wire {

/// The end of a TCP connection that this process has.
struct Connection {
    std::string peer;     ///< "10.0.0.7" or "fe80::1"; empty: it has hung up, the system forgot who
    bool isShut = false;  ///< this process sends no more, or the connection has ended

    bool operator==(const Connection&) const = default;
};

/// By descriptor.
using Connections = std::map<int, Connection>;

/// Those that this process has accepted at `ports`, as the system knows them at the moment.
Connections connectionsAt(const std::set<std::uint16_t>& ports);

/// Who is at the other end of what is shut in `after`; `before`, from while those descriptors were
/// the same connections, knows whom the system has forgotten since. Nothing: nothing is shut, or
/// what is has several peers, or one that nobody knows.
std::optional<std::string> peerOfShut(const Connections& before, const Connections& after);

}  // namespace eyrie::wire
