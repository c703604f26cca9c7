// SPDX-License-Identifier: Apache-2.0
#include "tests/support/http_client.h"

#include <array>
#include <cstdlib>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace eyrie::test {
namespace {

using Clock = std::chrono::steady_clock;

struct Socket {
    int id = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    Socket() = default;
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    ~Socket() { close(id); }
};

absl::Status connectTo(const Socket& socket, std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket.id, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return absl::UnavailableError(fmt::format("nobody listens on port {}", port));
    return absl::OkStatus();
}

absl::StatusOr<std::string> readToEnd(const Socket& socket, Clock::time_point end) {
    std::string text;
    std::array<char, 65536> buffer{};
    for (;;) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd readable{socket.id, POLLIN, 0};
        if (left <= 0 || poll(&readable, 1, static_cast<int>(left)) == 0)
            return absl::DeadlineExceededError("no answer in time");
        const ssize_t count = recv(socket.id, buffer.data(), buffer.size(), 0);
        if (count < 0)
            return absl::UnavailableError("the connection broke");
        if (count == 0)
            return text;
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

/// `rest`: what follows the headers that every request has, headers of its own first.
absl::StatusOr<HttpAnswer> ask(std::uint16_t port, const std::string& line, const std::string& rest,
                               std::chrono::milliseconds limit) {
    const Socket socket;
    if (const absl::Status status = connectTo(socket, port); !status.ok())
        return status;
    const std::string request = fmt::format(
        "{} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n{}", line, port, rest);
    if (send(socket.id, request.data(), request.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(request.size()))
        return absl::UnavailableError("the request could not be sent");
    const auto text = readToEnd(socket, Clock::now() + limit);
    if (!text.ok())
        return text.status();
    const std::size_t blank = text->find("\r\n\r\n");
    if (!text->starts_with("HTTP/1.1 ") || blank == std::string::npos)
        return absl::InternalError("the answer is no HTTP/1.1");
    return HttpAnswer{std::atoi(text->c_str() + 9), text->substr(0, blank),
                      text->substr(blank + 4)};
}

absl::StatusOr<HttpAnswer> sendJson(std::uint16_t port, const std::string& line,
                                    const std::string& json, std::chrono::milliseconds limit) {
    return ask(port, line,
               fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{}",
                           json.size(), json),
               limit);
}

}  // namespace

absl::StatusOr<HttpAnswer> httpGet(std::uint16_t port, const std::string& target,
                                   std::chrono::milliseconds limit) {
    return ask(port, "GET " + target, "\r\n", limit);
}

absl::StatusOr<HttpAnswer> httpPatch(std::uint16_t port, const std::string& target,
                                     const std::string& json, std::chrono::milliseconds limit) {
    return sendJson(port, "PATCH " + target, json, limit);
}

absl::StatusOr<HttpAnswer> httpPost(std::uint16_t port, const std::string& target,
                                    const std::string& json, std::chrono::milliseconds limit) {
    return sendJson(port, "POST " + target, json, limit);
}

absl::StatusOr<HttpAnswer> httpPut(std::uint16_t port, const std::string& target,
                                   const std::string& json, std::chrono::milliseconds limit) {
    return sendJson(port, "PUT " + target, json, limit);
}

}  // namespace eyrie::test
