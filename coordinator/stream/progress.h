// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "coordinator/stream/pacer.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// A picture as it came from the frame source, for one view.
struct Picture {
    ViewRequest view;
    std::shared_ptr<const coordinator::RenderedFrame> frame;
    Clock::time_point started;
    std::optional<fabric::Camera> liftedCamera = {};  ///< shown where the view's is under ground
    int level = 0;                                    ///< QualityControl's, that it was drawn for
};

struct ProgressOptions {
    std::chrono::milliseconds restDelay;
    std::chrono::milliseconds retryDelay;
    std::chrono::milliseconds loadingDelay;
    std::chrono::milliseconds missingDelay;
};

/// How far the wanted view has come on its way to one browser, and so what is to be done next:
/// drawn as long as it moves; when it has rested, drawn once more where a limit had been set or
/// data were missing, then sent nearly exact, then exact. Then nothing, until something changes.
/// Not thread-safe.
class Progress {
public:
    explicit Progress(const ProgressOptions& options) : options_(options) {}

    /// True where it is another view than before, and not just another number of it.
    bool want(const ViewRequest& view, Clock::time_point now);
    const std::optional<ViewRequest>& wanted() const { return wanted_; }

    /// What pictures are made from has changed: the view is to be drawn again.
    void sourceChanged();

    /// The view has not moved for a while.
    bool hasRested(Clock::time_point now) const;

    // ---- Drawing, of several frames at once.

    bool mayRender(Clock::time_point now) const;
    /// When a frame is next to be drawn although nothing changes.
    std::optional<Clock::time_point> nextRender(Clock::time_point now) const;
    void renderStarted();
    /// One that began before one that is there already is left out.
    void rendered(Picture picture, Clock::time_point now);
    void renderFailed(Clock::time_point now);

    // ---- Encoding, by one thread.

    /// The picture to encode next, if there is one that has not been, or one to be sent finer;
    /// the second only where `hasRoom`.
    std::optional<Picture> takePicture(bool hasRoom, Clock::time_point now);
    /// When one is next to be sent finer although nothing changes.
    std::optional<Clock::time_point> nextFiner(Clock::time_point now) const;
    /// How fine to send `picture` now.
    Fineness fineness(const Picture& picture, Clock::time_point now) const;
    /// `isLost`: it could not be encoded, and will not be tried again.
    void encoded(Picture picture, Fineness fineness, bool isLost);

    /// How many frames are being drawn, encoded or wait for that.
    int underWay() const;

private:
    bool isShown() const;
    bool needsFull() const;
    bool needsFiner() const;
    bool isWaitingToRetry(Clock::time_point now) const;

    const ProgressOptions options_;
    std::optional<ViewRequest> wanted_;
    Clock::time_point wantedSince_;
    bool isRenderNeeded_ = false;
    std::optional<Clock::time_point> retryAt_;   ///< set after a failure
    std::optional<Clock::time_point> redrawAt_;  ///< set after an incomplete frame of this view
    bool isLoading_ = false;                     ///< it lacked data that are on their way

    int rendering_ = 0;                ///< frames
    Clock::time_point newest_{};       ///< when the newest that is there began
    std::optional<Picture> rendered_;  ///< for the encoder to take
    bool isEncoding_ = false;
    std::optional<Picture> last_;  ///< that was encoded
    Fineness lastFineness_ = Fineness::Moving;
};

}  // namespace eyrie::stream
