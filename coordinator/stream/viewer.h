// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include <absl/status/status.h>

#include "coordinator/stream/pick_desk.h"
#include "coordinator/stream/sessions.h"

namespace eyrie::stream {

/// One browser's stream of frames, without the network: bytes come in by receive() and go out by
/// takeMessage(), so nothing is ever queued for a browser that does not keep up. What it sees is a
/// Session's, which it may share with others.
///
/// At most as many frames are under way to it as the Pacer says, each as large as QualityControl
/// says, and an encoded frame that still waits is replaced by a newer one. A frame that fails
/// leaves the last picture in place and becomes the state's problem text.
///
/// All functions may be called from any thread.
class Viewer {
public:
    /// Calls `messageReady`, from any thread and without locks held, when takeMessage() may have
    /// something new. `sessions` outlives the viewer.
    Viewer(Sessions& sessions, const Joining& joining, const std::function<void()>& messageReady);

    /// `messageReady` is not called afterwards. The last viewer of a session waits for the frame
    /// being rendered.
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Takes a message from the browser. DataLoss when it is not in the protocol, after which the
    /// connection is to be closed. A view that cannot be drawn is no error: the browser is told.
    absl::Status receive(std::span<const std::byte> message);

    /// The next message to send, if any: the newest answer to a pick, else the newest state, else
    /// what follows of a picture.
    std::optional<std::string> takeMessage();

    /// How long a message without weight took to the browser and back.
    void roundTrip(std::chrono::steady_clock::duration time);

    /// For how long the oldest picture, or part of one, has been under way that the browser has not
    /// acknowledged; absent while there is none.
    std::optional<std::chrono::steady_clock::duration> unacknowledgedFor() const;

    /// From now on only what was asked for is drawn and sent, to it and to those who share its
    /// session, no finer than while a view moves; new views and picks are not heard.
    void drain();
    /// Whether all of that has been taken.
    bool hasDrained() const;

    /// Its session was closed by a program: the connection is to end. messageReady is called then.
    bool isClosed() const { return joined_.session->isClosed(); }

    /// It has come again by another connection: this one is to end. messageReady is called then.
    bool isReplaced() const { return joined_.seat->isReplaced; }

    /// Leaves the session; makes threads end soon, without waiting for them.
    void stop();

private:
    Sessions& sessions_;
    const Sessions::Joined joined_;
    PickDesk picks_;
    std::atomic<bool> isDraining_ = false;
};

}  // namespace eyrie::stream
