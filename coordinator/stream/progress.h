// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "coordinator/stream/pacer.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// A picture as it came from the frame source, for one view.
struct Picture {
    ViewRequest view;
    std::shared_ptr<const coordinator::RenderedFrame> frame;
    Clock::time_point started;
    std::optional<fabric::Camera> liftedCamera = {};  ///< shown where the view's is under ground
    std::optional<fabric::Vec3> lift = {};            ///< where it is, and may be: see liftOf()
    int level = 0;           ///< the best of QualityControl's that it is large enough for
    bool isReduced = false;  ///< drawn smaller than asked for, for a link's or a time's sake
    std::vector<coordinator::Shown> shown = {};  ///< the outputs that were asked for
    std::uint64_t number = 0;  ///< 1, 2, … in the order in which they were drawn
};

/// What a browser has been given last.
struct Delivered {
    std::uint64_t picture = 0;  ///< Picture::number; 0: none
    Fineness fineness = Fineness::Moving;
};

struct ProgressOptions {
    std::chrono::milliseconds restDelay;
    std::chrono::milliseconds retryDelay;
    std::chrono::milliseconds loadingDelay;
    std::chrono::milliseconds missingDelay;
};

/// How far the wanted view has come, and so what is to be done next: drawn as long as it moves;
/// when it has rested, drawn once more where a limit had been set or data were missing, then sent
/// to each browser nearly exact, then exact. Then nothing, until something changes. Not
/// thread-safe.
class Progress {
public:
    explicit Progress(const ProgressOptions& options) : options_(options) {}

    /// True where it is another view than before, and not just another number of it.
    bool want(const ViewRequest& view, Clock::time_point now);
    const std::optional<ViewRequest>& wanted() const { return wanted_; }

    /// What pictures are made from has changed: the view is to be drawn again.
    void sourceChanged();
    /// So has what the view is seen by, as heads do that move: it does not rest.
    void seenOtherwise(Clock::time_point now);

    /// The view has not moved for a while.
    bool hasRested(Clock::time_point now) const;

    // ---- Drawing, of several frames at once.

    bool mayRender(Clock::time_point now) const;
    /// The wanted view has not been drawn since it, or what it shows, changed; and not for want of
    /// renderers.
    bool owesPicture(Clock::time_point now) const {
        return isRenderNeeded_ && !isWaitingToRetry(now);
    }
    /// When a frame is next to be drawn although nothing changes.
    std::optional<Clock::time_point> nextRender(Clock::time_point now) const;
    void renderStarted();
    /// One that began before one that is there already is left out.
    void rendered(Picture picture, Clock::time_point now);
    void renderFailed(Clock::time_point now);
    int rendering() const { return rendering_; }  ///< frames that are being drawn

    // ---- Sending.

    /// Drawn last; null before any.
    const std::shared_ptr<const Picture>& newest() const { return newest_; }
    /// The newest picture is the best there is of the view that is wanted.
    bool isBest() const;
    /// How fine a browser that has `delivered` is now to get the newest picture; nothing where it
    /// has all there is.
    std::optional<Fineness> next(const Delivered& delivered, Clock::time_point now) const;
    /// When next() may change although nothing else does.
    std::optional<Clock::time_point> nextFiner(Clock::time_point now) const;
    /// The view that `picture` answers: the same may have been asked for again meanwhile.
    const ViewRequest& answered(const Picture& picture) const;

private:
    bool isShown() const;
    bool needsFull() const;
    bool isWaitingToRetry(Clock::time_point now) const;

    const ProgressOptions options_;
    std::optional<ViewRequest> wanted_;
    Clock::time_point wantedSince_;
    bool isRenderNeeded_ = false;
    std::optional<Clock::time_point> retryAt_;   ///< set after a failure
    std::optional<Clock::time_point> redrawAt_;  ///< set after an incomplete frame of this view
    bool isLoading_ = false;                     ///< it lacked data that are on their way
    int rendering_ = 0;
    std::shared_ptr<const Picture> newest_;
    std::uint64_t lastNumber_ = 0;
};

}  // namespace eyrie::stream
