// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/probe.h"

#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <fmt/format.h>

namespace eyrie::http {

absl::Status probe(const std::string& host, std::uint16_t port, const std::string& path,
                   std::chrono::milliseconds limit) {
    const std::string url = fmt::format("http://{}:{}{}", host, port, path);
    boost::asio::ip::tcp::iostream server;
    server.expires_after(limit);
    server.connect(host, std::to_string(port));
    if (server.error() != boost::system::error_code{} &&
        server.error() != boost::asio::error::timed_out)
        return absl::UnavailableError(fmt::format("{}: {}", url, server.error().message()));
    server << "GET " << path << " HTTP/1.1\r\nHost: " << host << ':' << port
           << "\r\nConnection: close\r\n\r\n"
           << std::flush;
    std::string version;
    int status = 0;
    server >> version >> status;
    if (server.error() == boost::asio::error::timed_out)
        return absl::DeadlineExceededError(
            fmt::format("{}: no answer within {} ms", url, limit.count()));
    if (!server || !version.starts_with("HTTP/1."))
        return absl::UnavailableError(fmt::format("{}: what answers is no HTTP server", url));
    if (status < 200 || status > 299)
        return absl::FailedPreconditionError(fmt::format("{}: it answers {}", url, status));
    return absl::OkStatus();
}

}  // namespace eyrie::http
