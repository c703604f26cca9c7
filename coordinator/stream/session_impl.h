// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "coordinator/stream/drawing.h"
#include "coordinator/stream/session.h"
#include "coordinator/stream/statistics_feed.h"
#include "coordinator/stream/swap_group.h"
#include "coordinator/stream/video_streams.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

using Seats = std::vector<std::shared_ptr<Seat>>;

/// The sooner, of what there is.
inline std::optional<Clock::time_point> sooner(const std::optional<Clock::time_point>& a,
                                               const std::optional<Clock::time_point>& b) {
    return a && b ? std::min(a, b) : a ? a : b;
}

/// For viewers to read.
inline std::string problemOf(const absl::Status& status) {
    return sanitised({status.message().data(), status.message().size()});
}

/// What is behind a session. Its parts each have a file: who is in it and what they are told
/// (session_people.cpp), the threads that have frames drawn (session_drawing.cpp), the thread that
/// encodes pictures and hands them out (session_serving.cpp), and swaps (session_swaps.cpp).
class Session::Impl {
public:
    Impl(coordinator::FrameSource& frames, std::string name, const SessionOptions& options,
         std::string id);
    ~Impl();
    std::shared_ptr<Seat> join(Role role, bool mayControl, const std::string& viewer,
                               std::function<void()> messageReady);
    bool leave(const std::shared_ptr<Seat>& seat);
    void want(Seat& seat, ViewRequest view);
    absl::Status change(const ViewChange& change);
    void close();
    bool isClosed() const;
    bool hasViewers() const;
    SessionFacts facts() const;
    void takeLead(Seat& seat);
    void show(Seat& seat, OwnScreen screen);
    void ready(Seat& seat, std::uint64_t swap);
    void switchLayout(Seat& seat, coordinator::SwitchLayout change);
    void acknowledged(Seat& seat, const FrameAck& ack);
    void able(Seat& seat, const Abilities& abilities);
    void refuse(Seat& seat, const absl::Status& why);
    void roundTrip(Seat& seat, Clock::duration time);
    std::optional<std::string> take(Seat& seat);
    std::optional<Clock::duration> unacknowledgedFor(Seat& seat);
    void drain();
    bool hasDrained(Seat& seat);
    SessionCounts counts() const;
    const std::string& name() const { return name_; }
    const std::string& id() const { return id_; }

private:
    /// Frames that are drawn for a session at once, at most: renderers decide whether more than one
    /// is, and the browsers whether there is room.
    static constexpr std::size_t kRenderThreads = 3;

    // ---- With mutex_ held. What takes the lock may give it up meanwhile.

    bool replace(const std::shared_ptr<Seat>& seat);
    bool isAwaited(const Seat& seat) const;
    bool freePlace(const std::shared_ptr<Seat>& seat);
    bool wantNow(const ViewRequest& view);
    void setProblem(std::string& problem, std::string value);
    void waitForChange(std::unique_lock<std::mutex>& lock,
                       std::optional<Clock::time_point> deadline);
    void tell(std::unique_lock<std::mutex>& lock);
    void composeStates(std::unique_lock<std::mutex>& lock);
    void putState(Seat& seat, const coordinator::Status& status);
    const std::string& ownProblem(const Seat& seat) const;

    // ---- Threads of the frame source.

    void statusChanged();

    // ---- The render threads.

    bool mayRender() const;
    void renderLoop();
    void switchLayout(std::unique_lock<std::mutex>& lock);
    void drawForAll();
    std::shared_ptr<Seat> uncheckedScreen() const;
    void checkScreen(std::unique_lock<std::mutex>& lock, const std::shared_ptr<Seat>& seat);
    std::vector<coordinator::Shown> screens(const coordinator::Shown& asked) const;
    int chooseLevel(const ViewRequest& view, Clock::time_point now);
    bool mayComeEncoded(int level) const;
    /// A frame that has begun.
    struct Begun {
        ViewRequest view;
        coordinator::FrameRequest request;
        Clock::time_point at;
        int level = 0;
        std::optional<fabric::Vec3> lift = {};
    };
    Begun begin();
    void renderOne(std::unique_lock<std::mutex>& lock);
    void rendered(const Begun& begun, absl::StatusOr<coordinator::RenderedFrame> frame);

    // ---- The encoder thread.

    void encodeLoop();
    std::optional<QualityClass> dueNow(const Seat& seat, Clock::time_point now) const;
    std::optional<QualityClass> nextClass(Clock::time_point now) const;
    Seats takeDue(const QualityClass& as, Clock::time_point now);
    void serve(std::unique_lock<std::mutex>& lock, const QualityClass& as);
    bool isStillBest(const Picture& picture) const;
    void give(Seat& seat, const std::shared_ptr<const EncodedPicture>& encoded,
              const QualityClass& as, const Picture& picture, std::uint64_t swap = 0);
    void replaceWaiting(const std::shared_ptr<const EncodedPicture>& encoded,
                        const QualityClass& as, const Picture& picture);
    absl::StatusOr<std::shared_ptr<const EncodedPicture>> encodingOf(
        std::unique_lock<std::mutex>& lock, const std::shared_ptr<const Picture>& picture,
        const QualityClass& as, const Seats& served);
    static int worstJpegLevel(const Seats& served, const Picture& picture);
    absl::StatusOr<EncodedPicture> encodeVideo(const Picture& picture, const QualityClass& as,
                                               bool asKey, int jpegLevel, Clock::time_point now);

    // ---- Swap barriers, by the same thread.

    const SwapGroup* groupOf(const Seat& seat) const;
    bool isInSwap(const Seat& seat) const;
    bool awaitsSwap(const Seat& seat) const;
    bool hasNewest(const Seat& seat) const;
    void leaveGroup(Seat& seat);
    void arrangeGroups();
    Seats sayWords(SwapGroup& group);
    bool endLateSwaps(std::unique_lock<std::mutex>& lock);
    std::optional<Clock::time_point> deadline() const;
    /// A swap that is to begin: to whom each is given what.
    struct Swap {
        std::shared_ptr<const Picture> picture;
        std::string barrier;
        std::vector<std::pair<std::shared_ptr<Seat>, QualityClass>> seats;
    };
    std::shared_ptr<Swap> nextSwap(Clock::time_point now);
    std::shared_ptr<Swap> swapOf(const std::string& barrier, SwapGroup& group,
                                 Clock::time_point now);
    void serveTogether(std::unique_lock<std::mutex>& lock, const Swap& swap);

    // ----

    coordinator::FrameSource& frames_;
    const std::string name_;
    const std::string id_;
    const std::chrono::system_clock::time_point created_ = std::chrono::system_clock::now();
    StatisticsFeed* const statistics_;
    const std::optional<int> framesInFlight_;
    const std::chrono::milliseconds swapPatience_;
    const observe::SharedTelemetry telemetry_;
    const std::uint64_t number_;  ///< of all sessions so far; in FrameRequest::session
    const std::string encoding_;  ///< its thread, in traces

    std::stop_source over_;     // requested once isStopping_: nobody wants a frame any more
    mutable std::mutex mutex_;  // guards everything below, up to the threads, and the seats
    std::condition_variable changed_;
    bool isStopping_ = false;
    bool isDraining_ = false;
    bool isClosed_ = false;
    bool isStarting_ = false;  ///< a render thread waits for its frame's turn
    Clock::time_point lastRendered_{};
    Seats seats_;                ///< in the order in which they came
    Seat* leader_ = nullptr;     ///< one of them
    Seats replaced_;             ///< not of them any more, and to be told
    std::string awaitedLeader_;  ///< Seat::viewer of who led and left: has an heir
    Clock::time_point leaderLeft_;
    std::map<std::string, SwapGroup> groups_;  ///< of the seats' barriers
    std::uint64_t lastSeat_ = 0;
    VideoStreams videos_;
    Progress progress_;
    std::map<QualityClass, std::shared_ptr<const EncodedPicture>> encodings_;  ///< of the newest
    std::optional<PictureSource> source_;
    std::optional<coordinator::SwitchLayout> switch_;  ///< asked for and not begun yet
    bool isAsking_ = false;  ///< a render thread switches or checks a screen: one at a time
    std::uint64_t requested_ = 0;
    SessionCounts counts_;
    bool isStateStale_ = true;
    std::string renderProblem_;
    std::string renderNote_;  ///< of the last frame

    int subscription_ = 0;
    std::thread encoder_;
    std::array<std::thread, kRenderThreads> renderers_;
};

}  // namespace eyrie::stream
