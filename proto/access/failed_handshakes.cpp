// SPDX-License-Identifier: Apache-2.0
#include "access/failed_handshakes.h"

#include <fmt/format.h>

#include "access/printable.h"

namespace eyrie::access {

std::optional<std::string> FailedHandshakes::warning(const std::optional<std::string>& address,
                                                     std::string_view reason,
                                                     Clock::time_point now) {
    const std::string who = address.value_or("a peer that has hung up");
    if (!warnings_.isDue(who, now))
        return std::nullopt;
    return fmt::format(
        "no encrypted connection with {}: {}; more from there within a minute are not told", who,
        printable(reason));
}

FailedHandshakes& FailedHandshakes::atGrpcPorts() {
    static FailedHandshakes& handshakes = *new FailedHandshakes();
    return handshakes;
}

}  // namespace eyrie::access
