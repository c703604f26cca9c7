// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <absl/status/statusor.h>

#include "access/gate.h"
#include "access/tls_files.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/http/crowd.h"
#include "coordinator/observe/telemetry.h"
#include "video/module.h"

namespace eyrie::api {
class RestDoor;
}
namespace eyrie::stream {
class SessionBook;
}

namespace eyrie::http {

struct ServerOptions {
    std::string host = "127.0.0.1";   ///< an address to listen on, or "localhost"
    std::uint16_t port = 8080;        ///< 0 lets the system choose; see Server::url
    std::filesystem::path webFolder;  ///< the built UI; a page says how to build it where missing
    /// What is below /api/v1/, but for nothing: 404 then. Outlives the server.
    const api::RestDoor* api = nullptr;
    CrowdLimits limits;  ///< who comes above them is answered 503, viewers 429, and closed
    /// Where programs see the viewers' sessions; null: nowhere.
    std::shared_ptr<stream::SessionBook> sessions = {};
    std::chrono::milliseconds headerTimeout{
        10'000};  ///< for a whole request; also between requests
    /// For one message to a viewer, for the viewer to acknowledge a picture, and for any of an
    /// answer to be taken (write_pace.h).
    std::chrono::milliseconds writeTimeout{10'000};
    /// Viewers hear so often that the server is there (viewer.proto).
    std::chrono::milliseconds lifeSign{3'000};
    int messagesPerSecond = 400;  ///< of one viewer; more wait (message_rate.h)
    /// Who comes in; null: everybody who can reach the address.
    std::shared_ptr<access::Gate> gate = {};
    /// Answers under no name but an address or "localhost", as on loopback without a gate.
    bool localNamesOnly = false;
    std::optional<access::TlsFiles> tls = {};  ///< HTTPS instead of HTTP
    /// How long viewers and calls may go on when the server stops, to get what they asked for.
    std::chrono::milliseconds drainTimeout{2'500};
    std::chrono::milliseconds swapPatience{1000};  ///< as stream::SessionOptions has it
    /// What it tells of itself, and what /metrics shows; null: of its own.
    observe::SharedTelemetry telemetry = nullptr;
    /// Codes moving pictures for viewers of slow links that can show H.264; null: all get JPEGs.
    const video::Module* video = nullptr;
};

/// The door for browsers: HTTP/1.1, or HTTPS, and the viewer's WebSocket on one port.
///
///   /          the UI, from webFolder (read once, at start)
///   /ws        viewer.proto over binary WebSocket messages; ?session=NAME shares a view, with
///              &role=watch without moving it; cross-origin requests get 403. A plain
///              GET is told why a WebSocket would be refused, or 426
///   /login     who one is, and a cookie for a token (access.h)
///   /healthz   200 while the process lives
///   /readyz    200 while a renderer is alive and a scene is open, 503 otherwise; JSON says why
///   /api       what programs can ask, for people to read; the calls of CoordinatorService are
///   below
///              /api/v1/ (api/rest_door.h)
///   /metrics   numbers for Prometheus
///
/// All functions may be called from any thread.
class Server {
public:
    /// Listens and serves on threads of its own until stop(). `frames` outlives the server.
    /// Errors: InvalidArgument (host is no address of this machine), Unavailable (the port is in
    /// use or not permitted), those of checkTlsFiles.
    static absl::StatusOr<std::unique_ptr<Server>> start(const ServerOptions& options,
                                                         coordinator::FrameSource& frames);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Where it listens: "http://127.0.0.1:8080/", with the port that was chosen.
    std::string url() const;

    /// Takes no more connections, calls and views, sends what has been asked for, for drainTimeout
    /// at most, and tells viewers that it goes away (close code 1001), and calls that are not done
    /// that they are to be made again (503); then ends every connection and thread. Returns when
    /// that is done; waits for a frame being rendered. May be called twice.
    void stop();

private:
    class Impl;
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::http
