// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/picture_source.h"
#include "fabric/flight.h"
#include "fabric/smaller_picture.h"
#include "fabric/statistics.h"

/// Playing a flight and taking its frames' times.
namespace eyrie::cli::bench {

struct PlayOptions {
    coordinator::FrameRequest request;  ///< all but the camera
    int frames = 120;                   ///< of one pass, evenly spaced in time; at least 1
    int repeats = 3;                    ///< passes that are measured, after a first one
    std::vector<int> keeps = {};        ///< frames of a pass, ascending, for Played::kept
};

/// How many pixels of a picture of `width` x `height` one of `drawn`'s covers, the longer way.
inline double stretch(const fabric::PictureSides& drawn, int width, int height) {
    return std::max(static_cast<double>(width) / drawn.width,
                    static_cast<double>(height) / drawn.height);
}

struct PlayedFrame {
    int pass = 0;        ///< 0: the first one, which loads; measured passes from 1
    double seconds = 0;  ///< of the flight
    /// From asking for the picture to having all of it; with several in flight, from the picture
    /// before it (of a pass's first: from its begin), and they may come in bursts.
    double milliseconds = 0;
    /// Errors in pixels of the size asked for, even where a smaller picture was drawn.
    fabric::FrameStatistics statistics;
    /// From choosing the view to having all of the picture: with one in flight the same as
    /// milliseconds.
    double latencyMilliseconds = 0;
    double stretch = 1;          ///< of the picture's pixels to those asked for
    bool showsSomething = true;  ///< some pixel is not the background's
};

/// Whether its promise is more than was asked for: its data were not there, did not fit into memory
/// or would have taken longer than a frame time to hold.
inline bool isBeyondTau(const PlayedFrame& frame) {
    return frame.statistics.tauAchievedPixels > frame.statistics.tauAskedPixels;
}

/// Whether it has fewer pixels than were asked for, to hold a frame time.
inline bool isSmaller(const PlayedFrame& frame) { return frame.stretch > 1; }

struct Played {
    std::vector<PlayedFrame> frames;      ///< pass by pass
    std::uint64_t peakResidentBytes = 0;  ///< this process and its children, added up
    fabric::DeviceInfo device;
    /// Drawn after all passes, evenly along the flight, with their stages measured.
    std::vector<fabric::StageMilliseconds> stages = {};
    /// What the bench itself does with each frame of the measured passes that has come, in percent
    /// of the frames' time. It is in no frame's milliseconds where one is in flight; where several
    /// are, it is in those of the next, which is being drawn meanwhile.
    double overheadPercent = 0;
    int framesInFlight = 1;  ///< at most
    /// The frames of PlayOptions::keeps, with depth, as they came in one more pass after the
    /// measured ones: reading depths is in no frame's time. Errors in pixels of their own size.
    std::vector<coordinator::RenderedFrame> kept = {};
};

/// What pictures take that are kept to be judged.
std::uint64_t keptBytes(const Played& played);

/// Frames of which the stages are measured, or as many as a pass has.
inline constexpr int kMeasuredFrames = 24;

/// Plays `flight` 1 + repeats times, with as many frames in flight as `pictures` can; every frame
/// waits for its data, unless the request says not. Where pictures are to be kept, once more.
/// `frameDone` is called after each of these. Errors: those of PictureSource::draw, naming the
/// second; those of framesOf; InvalidArgument after the first pass when no frame of it showed
/// anything; Cancelled.
absl::StatusOr<Played> play(PictureSource& pictures, const fabric::Flight& flight,
                            const PlayOptions& options, const std::function<void()>& frameDone,
                            const std::stop_token& stop);

}  // namespace eyrie::cli::bench
