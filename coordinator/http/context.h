// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>

#include <boost/asio/thread_pool.hpp>

#include "access/rare_warnings.h"
#include "coordinator/api/workers.h"
#include "coordinator/http/access.h"
#include "coordinator/http/crowd.h"
#include "coordinator/http/server.h"
#include "coordinator/http/static_files.h"
#include "coordinator/http/tls.h"
#include "coordinator/stream/sessions.h"

namespace eyrie::http {

/// A connection that the server can end.
class Session {
public:
    virtual ~Session() = default;

    /// Ends politely: a viewer is told. On the server's thread.
    virtual void shutDown() = 0;

    /// Gives up what other threads hold of the session. Once the server's thread has ended.
    virtual void abandon() = 0;
};

/// What the connections of one server share. Used on the server's thread only.
struct Context {
    ServerOptions options;
    StaticFiles files;
    coordinator::FrameSource& frames;
    /// Meant for this machine alone: so no stranger's name may lead a browser here.
    bool localNamesOnly = true;
    Access access;
    std::unique_ptr<Tls> tls;            ///< null: not encrypted
    Crowd crowd;                         ///< who is connected
    observe::SharedTelemetry telemetry;  ///< not null
    std::set<Session*> sessions = {};
    std::function<void()> sessionEnded = {};
    /// Do the API's calls, which may take as long as a picture.
    api::Workers callers{8, 64};
    /// Ends viewers, which may mean to wait for a frame being rendered.
    boost::asio::thread_pool reaper{1};
    /// What viewers see, by themselves or together.
    stream::Sessions viewing{
        frames,
        {.swapPatience = options.swapPatience, .telemetry = telemetry, .video = options.video},
        options.sessions};
    access::RareWarnings handshakes = {};  ///< that failed
    access::RareWarnings unread = {};      ///< requests that were refused before they were read
    access::RareWarnings seats = {};       ///< that viewers did not get
    std::size_t longBodies = 0;            ///< of changes, being read and worked on
};

/// A connection's place, and its viewer's; held until that, too, has ended.
using Slot = Crowd::Place;

}  // namespace eyrie::http
