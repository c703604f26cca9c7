// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace eyrie::wire {

/// A TCP connection on this machine, of which this process has both ends.
class LocalConnection {
public:
    /// The client comes from 127.0.0.`host`.
    explicit LocalConnection(std::uint8_t host = 1) {
        sockaddr_in address = place(1);
        socklen_t size = sizeof address;
        const auto* plain = reinterpret_cast<const sockaddr*>(&address);
        expect(bind(listener_, plain, size) == 0 && listen(listener_, 1) == 0);
        expect(getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
        port_ = ntohs(address.sin_port);
        const sockaddr_in from = place(host);
        expect(bind(client_, reinterpret_cast<const sockaddr*>(&from), sizeof from) == 0);
        expect(connect(client_, plain, size) == 0);
        server_ = accept(listener_, nullptr, nullptr);
        expect(server_ >= 0);
    }
    ~LocalConnection() {
        hangUp();
        close(server_);
        close(listener_);
    }
    LocalConnection(const LocalConnection&) = delete;
    LocalConnection& operator=(const LocalConnection&) = delete;

    std::uint16_t port() const { return port_; }
    int server() const { return server_; }

    void shutServer() const { shutdown(server_, SHUT_RDWR); }
    /// The client goes, and the server's end hears of it at once: a reset.
    void reset() {
        const linger now{1, 0};
        setsockopt(client_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
        hangUp();
    }
    void hangUp() {
        if (client_ >= 0)
            close(client_);
        client_ = -1;
    }

private:
    static sockaddr_in place(std::uint8_t host) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl((127U << 24) + host);
        return address;
    }
    static void expect(bool isDone) {
        if (!isDone)
            throw std::runtime_error("no connection on this machine");
    }

    const int listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    int client_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    int server_ = -1;
    std::uint16_t port_ = 0;
};

}  // namespace eyrie::wire
