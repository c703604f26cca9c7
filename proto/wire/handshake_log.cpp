// SPDX-License-Identifier: Apache-2.0
#include "wire/handshake_log.h"

#include <utility>

#include "wire/connections.h"

namespace eyrie::wire {
namespace {

/// Which lines of the log are of handshakes that failed.
struct Line {
    std::string_view file;
    std::string_view begin;
};
constexpr Line kBothEnds{"/security_handshaker.cc", "Security handshake failed: "};
constexpr Line kOurEnd{"/chttp2_server.cc", "Handshaking failed: "};

/// gRPC's error in such a line; empty: it is another.
std::string_view errorOf(std::string_view file, std::string_view message, const Line& line) {
    if (!file.ends_with(line.file) || !message.starts_with(line.begin))
        return {};
    return message.substr(line.begin.size());
}

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

/// "http request" of "UNKNOWN:Tls handshake failed: SSL_ERROR_SSL: error:0A00009C:SSL
/// routines::http request {file:…": what follows is for gRPC's developers.
std::string_view innermost(std::string_view error) {
    error = error.substr(0, error.find(" {"));
    const std::size_t routine = error.rfind("::");
    if (routine != std::string_view::npos)
        return error.substr(routine + 2);
    const std::size_t code = error.find("UNKNOWN:");
    return code == std::string_view::npos ? error : error.substr(code + 8);
}

/// What the connections of this process were when this thread's last handshake was about to fail.
thread_local std::optional<Connections> lastBefore;

}  // namespace

std::optional<std::string> whyHandshakeFailed(std::string_view error) {
    if (contains(error, "Handshake timed out"))
        return "it was not finished in time";
    // Others are reads and writes that failed, as of who only looks whether the port is open, and
    // handshakes that end with the server.
    if (!contains(error, " handshake failed: ") && !contains(error, "Cannot check peer"))
        return std::nullopt;
    return std::string(innermost(error));
}

void HandshakeLog::watch(int port) {
    const std::lock_guard lock(mutex_);
    ports_.insert(static_cast<std::uint16_t>(port));
}

std::optional<std::string> HandshakeLog::note(std::string_view file, std::string_view message,
                                              Clock::time_point now) {
    const std::string_view before = errorOf(file, message, kBothEnds);
    const std::string_view after = errorOf(file, message, kOurEnd);
    const std::optional<std::string> why = whyHandshakeFailed(before.empty() ? after : before);
    if (!why)
        return std::nullopt;
    if (!before.empty()) {
        lastBefore.reset();
        if (mayLook(now))
            lastBefore = connectionsAt(ports());
        return std::nullopt;
    }
    handshakes_.count();
    const std::optional<Connections> known = std::exchange(lastBefore, std::nullopt);
    if (!known)
        return std::nullopt;
    return handshakes_.warning(peerOfShut(*known, connectionsAt(ports())), *why, now);
}

bool HandshakeLog::mayLook(Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (now - second_ >= std::chrono::seconds(1)) {
        second_ = now;
        looks_ = 0;
    }
    return ++looks_ <= kMaxLooks;
}

std::set<std::uint16_t> HandshakeLog::ports() const {
    const std::lock_guard lock(mutex_);
    return ports_;
}

}  // namespace eyrie::wire
