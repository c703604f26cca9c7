// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <absl/status/status.h>

#include "coordinator/frame/frame_source.h"
#include "coordinator/observe/telemetry.h"
#include "coordinator/stream/seat.h"
#include "video/module.h"

namespace eyrie::stream {

struct SessionOptions {
    /// Frames that may be under way to a viewer at once; absent leaves it to the Pacer's rule.
    std::optional<int> framesInFlight = {};
    /// How long a view rests before it is sent once more, nearly exact and then exact.
    std::chrono::milliseconds restDelay{150};
    /// How long after a failed frame the same view is tried again.
    std::chrono::milliseconds retryDelay{1000};
    /// After a frame that shows less than it should because data are still being loaded, the same
    /// view is drawn again, with this pause for the loading.
    std::chrono::milliseconds loadingDelay{30};
    /// The same when all that is missing could not be read, and may be readable later.
    std::chrono::milliseconds missingDelay{5000};
    /// How long the screens behind a swap barrier wait for one of them.
    std::chrono::milliseconds swapPatience{1000};
    observe::SharedTelemetry telemetry = nullptr;  ///< is told how long pictures take to encode
    const video::Module* video = nullptr;  ///< codes H.264 for slow links; null: nothing does
};

/// What a session has done so far.
struct SessionCounts {
    std::uint64_t drawn = 0;    ///< frames
    std::uint64_t encoded = 0;  ///< pictures, each for all viewers of a quality class
    std::uint64_t given = 0;    ///< pictures to viewers
};

/// One view, which one viewer moves and any number see.
///
/// The newest view request of the leader replaces the one before. Render threads have it drawn,
/// several frames at once where renderers would be idle, while another thread encodes the frame
/// before. It is drawn whenever a viewer that has the newest
/// picture has room for one more, so at the pace of the fastest; each viewer gets the newest
/// picture when it has room itself, and what it has left out never is sent. Pictures are drawn as
/// large as the best link takes them, and encoded once for each class of links (QualityControl's
/// levels), shrunk for worse ones; for slow ones as a stream of H.264 where there is a module for
/// it (VideoStreams). A view that rests is sent as a JPEG of quality 95, and then as a PNG that is
/// the server's picture bit for bit. Nothing is rendered or sent while neither the view nor the
/// scene nor the renderers change and all viewers have the last picture.
///
/// A viewer may have a screen of its own, another picture of the configuration than the leader's:
/// all that are seen are drawn in one frame, of one version of the frame data. Those whose screens
/// share a swap barrier are given moving pictures by swaps (SwapGroup), and finer ones of what they
/// all show each by itself.
///
/// All functions may be called from any thread.
class Session {
public:
    /// `frames` outlives the session. `name` is for viewers to read; empty where it has but one.
    Session(coordinator::FrameSource& frames, std::string name, const SessionOptions& options);

    /// Waits for the frame being rendered.
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// A place in the session; null once the last viewer has left. Who may not control neither
    /// switches layouts nor takes the lead.
    std::shared_ptr<Seat> join(Role role, bool mayControl, std::function<void()> messageReady);

    /// With the last one, of which this is true, the threads end soon, without waiting for them.
    bool leave(const std::shared_ptr<Seat>& seat);

    void want(Seat& seat, const ViewRequest& view);  ///< nothing where another leads
    void takeLead(Seat& seat);                       ///< refused to who may not control
    void show(Seat& seat, OwnScreen screen);
    void ready(Seat& seat, std::uint64_t swap);  ///< the picture that it was given with that
    /// Refused where another leads, and to who may not control.
    void switchLayout(Seat& seat, coordinator::SwitchLayout change);
    void acknowledged(Seat& seat, const FrameAck& ack);
    void able(Seat& seat, const Abilities& abilities);
    void refuse(Seat& seat, const absl::Status& why);  ///< a request: its viewer is told
    void roundTrip(Seat& seat, Clock::duration time);

    /// The next message for it, if any: the newest state, else what follows of a picture.
    std::optional<std::string> take(Seat& seat);

    /// See Viewer.
    std::optional<Clock::duration> unacknowledgedFor(Seat& seat);

    /// From now on only what was asked for is drawn and sent, no finer than while a view moves; new
    /// views are not heard.
    void drain();
    /// Whether the seat has all of that.
    bool hasDrained(Seat& seat);

    SessionCounts counts() const;
    const std::string& name() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::stream
