// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/play.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "cli/bench/resident_memory.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// Of frame `index` of a pass: both ends of the flight are drawn.
double secondsOf(const fabric::Flight& flight, int index, int frames) {
    return frames == 1 ? 0 : flight.seconds() * index / (frames - 1);
}

}  // namespace

absl::StatusOr<Played> play(PictureSource& pictures, const fabric::Flight& flight,
                            const PlayOptions& options, const std::function<void()>& frameDone,
                            const std::stop_token& stop) {
    Played played;
    coordinator::FrameRequest request = options.request;
    resetPeakResidentBytes();
    for (int pass = 0; pass <= options.repeats; ++pass) {
        for (int i = 0; i < options.frames; ++i) {
            if (stop.stop_requested())
                return absl::CancelledError("stopped; nothing was written");
            const double seconds = secondsOf(flight, i, options.frames);
            request.camera = flight.at(seconds);
            const auto start = Clock::now();
            const auto frame = pictures.draw(request);
            const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
            if (!frame.ok())
                return fabric::withContext(frame.status(),
                                           fmt::format("second {:.3f} of the flight", seconds));
            fabric::FrameStatistics statistics = frame->statistics;
            statistics.tauAchievedPixels *=
                static_cast<double>(request.width) / frame->image.area.width;
            played.frames.push_back({pass, seconds, taken.count(), statistics});
            played.device = frame->device;
            frameDone();
        }
    }
    played.peakResidentBytes = peakResidentBytes();
    request.measuresStages = true;
    const int measured = std::min(options.frames, kMeasuredFrames);
    for (int i = 0; i < measured && !stop.stop_requested(); ++i) {
        request.camera = flight.at(secondsOf(flight, i, measured));
        ASSIGN_OR_RETURN(const coordinator::RenderedFrame frame, pictures.draw(request));
        played.stages.push_back(frame.statistics.milliseconds);
    }
    return played;
}

}  // namespace eyrie::cli::bench
