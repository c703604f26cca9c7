// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "coordinator/frame/frame_source.h"
#include "coordinator/observe/telemetry.h"
#include "coordinator/stream/seat.h"
#include "video/module.h"

namespace eyrie::stream {

class StatisticsFeed;

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
    StatisticsFeed* statistics = nullptr;  ///< is told of each frame; outlives the session
};

/// What a session has done so far.
struct SessionCounts {
    std::uint64_t drawn = 0;    ///< frames
    std::uint64_t encoded = 0;  ///< pictures, each for all viewers of a quality class
    std::uint64_t given = 0;    ///< pictures to viewers
};

/// A browser of a session, for programs.
struct ViewerFacts {
    std::uint64_t id = 0;  ///< Seat::id
    std::chrono::system_clock::time_point joined = {};
    bool leads = false;
    Role role = Role::Lead;  ///< that it came with
    bool mayControl = false;
    LastGiven last = {};
    std::uint64_t given = 0;                    ///< pictures
    std::optional<double> bytesPerSecond = {};  ///< of its link; absent: not known
};

/// A session, for programs.
struct SessionFacts {
    std::chrono::system_clock::time_point created = {};
    std::vector<ViewerFacts> viewers = {};  ///< in the order in which they came
    std::optional<ViewRequest> view = {};   ///< that is wanted; nothing: nobody has asked yet
    std::shared_ptr<const coordinator::RenderedFrame> frame = {};  ///< drawn last; null: none
    SessionCounts counts = {};
};

/// What of a view is to be otherwise.
struct ViewChange {
    std::optional<fabric::Camera> camera = {};
    std::optional<double> tauPixels = {};
    std::optional<fabric::Shading> shading = {};
    std::optional<fabric::Look> look = {};
    std::optional<bool> isUnderground = {};
    std::optional<coordinator::Shown> shown = {};
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
    /// `id` is what programs know it by.
    Session(coordinator::FrameSource& frames, std::string name, const SessionOptions& options,
            std::string id = {});

    /// Waits for the frame being rendered.
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// A place in the session; null once the last viewer has left. Who may not control neither
    /// switches layouts nor takes the lead. `viewer` is Joining's: a place taken under the same
    /// before is replaced (Seat::isReplaced), and its viewer told.
    std::shared_ptr<Seat> join(Role role, bool mayControl, const std::string& viewer,
                               std::function<void()> messageReady);

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

    // ---- For programs.

    const std::string& id() const;
    SessionFacts facts() const;
    /// In place of what was wanted, for all viewers; who leads is told and goes on from there.
    /// Where nobody has asked for anything yet, a view of 1280x720 pixels. Errors:
    /// FailedPrecondition (a camera is needed), NotFound (the last viewer has left), Unavailable
    /// (the server is ending).
    absl::Status change(const ViewChange& change);
    /// From now on viewers are to be sent away (isClosed), and are told.
    void close();
    bool isClosed() const;
    /// Before close(), and until the last has left.
    bool hasViewers() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::stream
