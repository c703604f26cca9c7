// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <set>

#include <boost/asio/thread_pool.hpp>

#include "coordinator/http/server.h"
#include "coordinator/http/static_files.h"

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
    bool isLoopback = true;
    /// Not null.
    observe::SharedTelemetry telemetry = std::make_shared<observe::Telemetry>();
    std::set<Session*> sessions = {};
    std::function<void()> sessionEnded = {};
    /// Ends viewers, which may mean to wait for a frame being rendered.
    boost::asio::thread_pool reaper{1};
};

/// A connection's place among the `maxConnections`; held until its viewer, too, has ended.
using Slot = std::shared_ptr<void>;

}  // namespace eyrie::http
