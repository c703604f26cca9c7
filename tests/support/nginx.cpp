// SPDX-License-Identifier: Apache-2.0
#include "tests/support/nginx.h"

#include <fstream>
#include <stdexcept>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/http_client.h"

namespace eyrie::test {
namespace {

/// Free a moment ago.
std::uint16_t freePort() {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const bool isBound = bind(socket, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                         getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0;
    close(socket);
    if (!isBound)
        throw std::runtime_error("no port is free");
    return ntohs(address.sin_port);
}

}  // namespace

Nginx::Nginx(const std::filesystem::path& data) : port_(freePort()) {
    const std::string folder = folder_.path().string();
    std::string temporary;
    for (const char* kind : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"})
        temporary += fmt::format("  {0}_temp_path {1}/{0};\n", kind, folder);
    // Started as root its workers would be somebody who may not enter the folder.
    folder_.write("nginx.conf", fmt::format("{}daemon off;\nworker_processes 1;\npid {}/pid;\n"
                                            "events {{}}\nhttp {{\n{}"
                                            "  log_format bytes '$body_bytes_sent';\n"
                                            "  access_log {}/access.log bytes;\n"
                                            "  server {{ listen 127.0.0.1:{}; root {}; }}\n}}\n",
                                            geteuid() == 0 ? "user root;\n" : "", folder, temporary,
                                            folder, port_, data.string()));
    start();
}

void Nginx::start() {
    process_ = std::make_unique<Process>(
        std::vector<std::string>{"/usr/sbin/nginx", "-p", folder_.path().string(), "-e",
                                 folder_.path("error.log"), "-c", folder_.path("nginx.conf")});
    const bool answers = eventually(std::chrono::seconds(10), [this] {
        return process_->waitFor({}).has_value() || httpGet(port_, "/none").ok();
    });
    if (!answers || process_->waitFor({}))
        throw std::runtime_error("nginx does not start: " + process_->errors());
}

std::string Nginx::url(const std::string& name) const {
    return fmt::format("http://127.0.0.1:{}/{}", port_, name);
}

std::uint64_t Nginx::bytesSent() const {
    std::ifstream log(folder_.path("access.log"));
    std::uint64_t sum = 0;
    for (std::uint64_t bytes = 0; log >> bytes;) sum += bytes;
    return sum;
}

}  // namespace eyrie::test
