// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/probe.h"

#include <sstream>
#include <string>
#include <string_view>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>

#include "coordinator/http/host_and_port.h"
#include "fabric/status.h"

namespace eyrie::http {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMaxStatusLine = 4096;

/// Blocking steps on a socket, all within one limit.
class Steps {
public:
    Steps(std::string url, std::chrono::milliseconds limit)
        : url_(std::move(url)), limit_(limit), end_(std::chrono::steady_clock::now() + limit) {}

    /// Runs what `begin` begins, which ends with a call of the handler that it is given.
    template <typename Begin>
    absl::Status run(Begin begin, std::string_view otherwise = {}) {
        error_code error;
        begin([&error](const error_code& found, const auto&...) { error = found; });
        io_.restart();
        io_.run_until(end_);
        if (!io_.stopped()) {
            socket_.close(error);
            io_.run();  // the handler is called before what it refers to goes
            return absl::DeadlineExceededError(
                fmt::format("{}: no answer within {} ms", url_, limit_.count()));
        }
        if (!error)
            return absl::OkStatus();
        return absl::UnavailableError(
            fmt::format("{}: {}", url_, otherwise.empty() ? error.message() : otherwise));
    }

    absl::Status connect(const Probed& probed) {
        error_code error;
        const auto places =
            tcp::resolver(io_).resolve(probed.host, std::to_string(probed.port), error);
        if (error)
            return absl::UnavailableError(fmt::format("{}: {}", url_, error.message()));
        return run([&](auto handler) { asio::async_connect(socket_, places, handler); });
    }

    tcp::socket& socket() { return socket_; }
    const std::string& url() const { return url_; }

private:
    const std::string url_;
    const std::chrono::milliseconds limit_;
    const std::chrono::steady_clock::time_point end_;
    asio::io_context io_;
    tcp::socket socket_{io_};
};

absl::Status checkStatusLine(const std::string& line, const std::string& url) {
    std::istringstream words(line);
    std::string version;
    int status = 0;
    words >> version >> status;
    if (!words || !version.starts_with("HTTP/1."))
        return absl::UnavailableError(fmt::format("{}: what answers is no HTTP server", url));
    if (status < 200 || status > 299)
        return absl::FailedPreconditionError(fmt::format("{}: it answers {}", url, status));
    return absl::OkStatus();
}

template <typename Stream>
absl::Status ask(Stream& stream, Steps& steps, const Probed& probed) {
    const std::string request =
        fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", probed.path,
                    hostAndPort(probed.host, probed.port));
    RETURN_IF_ERROR(steps.run(
        [&](auto handler) { asio::async_write(stream, asio::buffer(request), handler); }));
    std::string line;
    RETURN_IF_ERROR(steps.run(
        [&](auto handler) {
            asio::async_read_until(stream, asio::dynamic_buffer(line, kMaxStatusLine), "\r\n",
                                   handler);
        },
        "what answers is no HTTP server"));
    return checkStatusLine(line, steps.url());
}

absl::Status believe(asio::ssl::context& context, const Trust& trust) {
    error_code error;
    context.set_verify_mode(asio::ssl::verify_peer);
    if (trust.authority.empty())
        context.set_default_verify_paths(error);
    else
        context.load_verify_file(trust.authority, error);
    if (error)
        return absl::InvalidArgumentError(
            fmt::format("{}: no certificates in PEM form", trust.authority));
    return absl::OkStatus();
}

absl::Status askEncrypted(Steps& steps, const Probed& probed, const Trust& trust) {
    const std::string name = trust.name.empty() ? probed.host : trust.name;
    asio::ssl::context context(asio::ssl::context::tls_client);
    RETURN_IF_ERROR(believe(context, trust));
    asio::ssl::stream<tcp::socket&> stream(steps.socket(), context);
    stream.set_verify_callback(asio::ssl::host_name_verification(name));
    // Which of a server's certificates is meant; of addresses there is no such saying.
    error_code notAnAddress;
    asio::ip::make_address(name, notAnAddress);
    if (notAnAddress)
        SSL_set_tlsext_host_name(stream.native_handle(), name.c_str());
    const absl::Status shaken = steps.run(
        [&](auto handler) { stream.async_handshake(asio::ssl::stream_base::client, handler); });
    if (absl::IsUnavailable(shaken))
        return absl::FailedPreconditionError(shaken.message());  // somebody is there
    RETURN_IF_ERROR(shaken);
    return ask(stream, steps, probed);
}

}  // namespace

absl::Status probe(const Probed& probed, std::chrono::milliseconds limit, const Trust& trust) {
    Steps steps(fmt::format("http{}://{}{}", probed.isEncrypted ? "s" : "",
                            hostAndPort(probed.host, probed.port), probed.path),
                limit);
    RETURN_IF_ERROR(steps.connect(probed));
    return probed.isEncrypted ? askEncrypted(steps, probed, trust)
                              : ask(steps.socket(), steps, probed);
}

}  // namespace eyrie::http
