// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/server.h"

#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>

#include "coordinator/http/context.h"
#include "coordinator/http/host_and_port.h"
#include "coordinator/http/http_session.h"
#include "fabric/log.h"
#include "fabric/status.h"

namespace eyrie::http {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

/// After viewers have been drained: for their last messages and goodbyes.
constexpr std::chrono::seconds kShutDownTimeout{1};
constexpr std::chrono::milliseconds kPauseAfterFailedAccept{100};

constexpr std::string_view kBusyReply =
    "HTTP/1.1 503 Service Unavailable\r\nContent-Type: text/plain\r\nRetry-After: 5\r\n"
    "Connection: close\r\nContent-Length: 42\r\n\r\n"
    "Too many connections; try again in a bit.\n";

absl::Status cannotListen(const ServerOptions& options, const error_code& error) {
    const std::string place = hostAndPort(options.host, options.port);
    if (error == boost::asio::error::address_in_use)
        return absl::UnavailableError(
            fmt::format("cannot listen on {}: another program does already", place));
    if (error == boost::asio::error::access_denied)
        return absl::UnavailableError(
            fmt::format("cannot listen on {}: permission denied for ports below 1024", place));
    return absl::InvalidArgumentError(fmt::format(
        "cannot listen on {}: {}; choose an address of this machine with --listen HOST:PORT", place,
        error.message()));
}

absl::StatusOr<tcp::endpoint> endpointOf(const ServerOptions& options) {
    error_code error;
    const std::string host = options.host == "localhost" ? "127.0.0.1" : options.host;
    const auto address = boost::asio::ip::make_address(host, error);
    if (error)
        return absl::InvalidArgumentError(
            fmt::format("cannot listen on {}: \"{}\" is no IP address; use --listen HOST:PORT with "
                        "127.0.0.1, 0.0.0.0 or another address of this machine",
                        hostAndPort(options.host, options.port), options.host));
    return tcp::endpoint(address, options.port);
}

}  // namespace

class Server::Impl {
public:
    Impl(const ServerOptions& options, StaticFiles files, std::unique_ptr<Tls> tls,
         bool localNamesOnly, coordinator::FrameSource& frames)
        : context_{options,
                   std::move(files),
                   frames,
                   localNamesOnly,
                   Access(options.gate, localNamesOnly, tls != nullptr),
                   std::move(tls),
                   Crowd(options.limits),
                   options.telemetry ? options.telemetry : std::make_shared<observe::Telemetry>(),
                   {},
                   [this] { sessionEnded(); }} {}

    ~Impl() { stop(); }

    absl::Status listen(const tcp::endpoint& endpoint) {
        error_code error;
        acceptor_.open(endpoint.protocol(), error);
        if (!error)
            acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
        if (!error)
            acceptor_.bind(endpoint, error);
        if (!error)
            acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
        if (error)
            return cannotListen(context_.options, error);
        port_ = acceptor_.local_endpoint().port();
        accept();
        thread_ = std::thread([this] { io_.run(); });
        return absl::OkStatus();
    }

    std::string url() const {
        return fmt::format("{}://{}/", context_.tls ? "https" : "http",
                           hostAndPort(context_.options.host, port_));
    }

    void stop() {
        const std::lock_guard lock(stopMutex_);
        if (!thread_.joinable())
            return;
        boost::asio::post(io_, [this] { shutDown(); });
        thread_.join();
        for (Session* session : context_.sessions) session->abandon();
        context_.reaper.join();
        context_.callers.stop();
        context_.sessionEnded = [] {};  // what is left goes with io_, after the timers
    }

private:
    void accept() {
        acceptor_.async_accept([this](error_code error, tcp::socket socket) {
            if (!acceptor_.is_open())
                return;
            if (error)
                return acceptLater(error);
            welcome(std::move(socket));
            accept();
        });
    }

    /// Out of file descriptors, most likely: trying again at once would only burn a core.
    void acceptLater(const error_code& why) {
        if (context_.unread.isDue("accept", access::RareWarnings::Clock::now()))
            spdlog::warn("no connection can be taken: {}; more such within a minute are not told",
                         why.message());
        pause_.expires_after(kPauseAfterFailedAccept);
        pause_.async_wait([this](error_code error) {
            if (!error)
                accept();
        });
    }

    void welcome(tcp::socket socket) {
        Slot slot = context_.crowd.enter();
        if (slot == nullptr && context_.unread.isDue("all", access::RareWarnings::Clock::now()))
            spdlog::warn(
                "all {} connections are in use, and others are turned away; more such within a "
                "minute are not told",
                context_.options.limits.connections);
        if (slot == nullptr)
            return refuse(std::move(socket), context_.tls != nullptr, *context_.telemetry);
        openHttpSession(std::move(socket), context_, std::move(slot));
    }

    static void refuse(tcp::socket socket, bool isEncrypted, observe::Telemetry& telemetry) {
        telemetry.metrics.refused(503);
        if (isEncrypted)
            return;  // closing says it; there was no handshake
        // The reply fits into the empty send buffer; where it does not, closing says it too.
        error_code ignored;
        socket.non_blocking(true, ignored);
        boost::asio::write(socket, boost::asio::buffer(kBusyReply.data(), kBusyReply.size()),
                           ignored);
        socket.shutdown(tcp::socket::shutdown_send, ignored);
    }

    /// Lets the loop run out of work; what has not ended in time is cut off.
    void shutDown() {
        error_code ignored;
        acceptor_.close(ignored);
        pause_.cancel();
        isShuttingDown_ = true;
        shutDownDeadline_.expires_after(context_.options.drainTimeout + kShutDownTimeout);
        shutDownDeadline_.async_wait([this](error_code error) {
            if (!error)
                io_.stop();
        });
        const std::set<Session*> sessions = context_.sessions;
        for (Session* session : sessions) session->shutDown();
        sessionEnded();
    }

    void sessionEnded() {
        if (isShuttingDown_ && context_.sessions.empty())
            shutDownDeadline_.cancel();
    }

    Context context_;
    boost::asio::io_context io_{1};
    tcp::acceptor acceptor_{io_};
    boost::asio::steady_timer pause_{io_};
    boost::asio::steady_timer shutDownDeadline_{io_};
    bool isShuttingDown_ = false;
    std::uint16_t port_ = 0;
    std::mutex stopMutex_;
    std::thread thread_;
};

absl::StatusOr<std::unique_ptr<Server>> Server::start(const ServerOptions& options,
                                                      coordinator::FrameSource& frames) {
    ASSIGN_OR_RETURN(StaticFiles files, StaticFiles::read(options.webFolder));
    ASSIGN_OR_RETURN(const tcp::endpoint endpoint, endpointOf(options));
    std::unique_ptr<Tls> tls;
    if (options.tls) {
        ASSIGN_OR_RETURN(tls, Tls::open(*options.tls));
    }
    const bool localNamesOnly =
        options.localNamesOnly || (endpoint.address().is_loopback() && options.gate == nullptr);
    auto impl =
        std::make_unique<Impl>(options, std::move(files), std::move(tls), localNamesOnly, frames);
    RETURN_IF_ERROR(impl->listen(endpoint));
    return std::unique_ptr<Server>(new Server(std::move(impl)));
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;

std::string Server::url() const { return impl_->url(); }
void Server::stop() { impl_->stop(); }

}  // namespace eyrie::http
