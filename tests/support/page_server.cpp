// SPDX-License-Identifier: Apache-2.0
#include "tests/support/page_server.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace eyrie::test {
namespace {

constexpr int kPollMilliseconds = 20;

/// False when there is nothing to read yet.
bool isReadable(int socket) {
    pollfd wait{socket, POLLIN, 0};
    return poll(&wait, 1, kPollMilliseconds) > 0;
}

bool sendAll(int connection, std::string_view text) {
    while (!text.empty()) {
        const ssize_t sent = send(connection, text.data(), text.size(), MSG_NOSIGNAL);
        if (sent <= 0)
            return false;
        text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

std::string refusal(int status) {
    return fmt::format("HTTP/1.1 {} Sorry\r\nContent-Length: 0\r\n\r\n", status);
}

}  // namespace

PageServer::PageServer(std::string content) : content_(std::move(content)) {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        listen(listener_, 64) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        throw std::runtime_error("cannot listen on the loopback");
    port_ = ntohs(address.sin_port);
    acceptor_ = std::thread([this] { accept(); });
}

PageServer::~PageServer() {
    isStopping_ = true;
    acceptor_.join();
    for (std::thread& connection : connections_) connection.join();
    close(listener_);
}

std::string PageServer::url(const std::string& name) const {
    return fmt::format("http://127.0.0.1:{}/{}", port_, name);
}

void PageServer::setContent(std::string content) {
    const std::lock_guard lock(contentMutex_);
    content_ = std::move(content);
}

std::string PageServer::content() const {
    const std::lock_guard lock(contentMutex_);
    return content_;
}

void PageServer::accept() {
    while (!isStopping_) {
        if (!isReadable(listener_))
            continue;
        const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (connection < 0)
            continue;
        connections_.emplace_back([this, connection] { serve(connection); });
    }
}

void PageServer::serve(int connection) {
    std::string received;
    bool goesOn = true;
    while (goesOn && !isStopping_) {
        if (!isReadable(connection))
            continue;
        char buffer[4096];
        const ssize_t got = recv(connection, buffer, sizeof buffer, 0);
        if (got <= 0)
            break;
        received.append(buffer, static_cast<std::size_t>(got));
        if (const std::size_t end = received.find("\r\n\r\n"); end != std::string::npos) {
            goesOn = answer(connection, received.substr(0, end + 2));
            received.erase(0, end + 4);
        }
    }
    close(connection);
}

/// Whether the connection stays open.
bool PageServer::answer(int connection, const std::string& request) {
    const bool isHead = request.starts_with("HEAD");
    ++(isHead ? heads_ : gets_);
    const Mood mood = mood_;
    if (mood == Mood::Stalls) {
        while (!isStopping_ && mood_ == Mood::Stalls) usleep(1000 * kPollMilliseconds);
        return false;
    }
    if (mood == Mood::HangsUp)
        return false;
    if (mood == Mood::NotFound || mood == Mood::ServerError || mood == Mood::Busy)
        return sendAll(connection, refusal(mood == Mood::NotFound      ? 404
                                           : mood == Mood::ServerError ? 500
                                                                       : 503));
    const std::string whole = content();
    const std::size_t range = request.find("Range: bytes=");
    if (isHead || range == std::string::npos || mood == Mood::IgnoresRange)
        return sendAll(connection, fmt::format("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n\r\n",
                                               whole.size())) &&
               (isHead || sendAll(connection, whole));
    char* next = nullptr;
    const std::size_t first = std::strtoull(request.c_str() + range + 13, &next, 10);
    const std::size_t last =
        std::min<std::size_t>(std::strtoull(next + 1, nullptr, 10), whole.size() - 1);
    if (first >= whole.size())
        return sendAll(connection, refusal(416));
    std::int64_t refused = refused_;
    if (refused >= static_cast<std::int64_t>(first) && refused <= static_cast<std::int64_t>(last) &&
        refused_.compare_exchange_strong(refused, -1))
        return sendAll(connection, refusal(503));
    const std::size_t bytes = last - first + 1;
    const std::string header = fmt::format(
        "HTTP/1.1 206 Partial Content\r\nContent-Length: {}\r\nContent-Range: bytes "
        "{}-{}/{}\r\n\r\n",
        bytes, first, last, whole.size());
    const std::string body = whole.substr(first, mood == Mood::ClosesMidway ? bytes / 2 : bytes);
    return sendAll(connection, header + body) && mood != Mood::ClosesMidway;
}

}  // namespace eyrie::test
