// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/play.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "cli/bench/flights.h"
#include "cli/bench/resident_memory.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

absl::Status nothingSeen(const fabric::Box& bounds) {
    return absl::InvalidArgumentError(fmt::format(
        "no frame of the flight shows anything of the scene, which lies between "
        "({}, {}, {}) and ({}, {}, {}); fly where the data are",
        bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z));
}

/// A pass over the flight's frames; their pictures are timed, and nothing else.
class Pass {
public:
    Pass(PictureSource& pictures, const std::function<void()>& frameDone,
         const std::stop_token& stop, Played& played)
        : pictures_(pictures), frameDone_(frameDone), stop_(stop), played_(played) {}

    absl::Status play(int pass, const std::vector<fabric::FlightKey>& frames,
                      coordinator::FrameRequest request) {
        const auto begin = Clock::now();
        double drawing = 0;
        for (const fabric::FlightKey& key : frames) {
            if (stop_.stop_requested())
                return absl::CancelledError("stopped; nothing was written");
            request.camera = key.camera;
            const auto start = Clock::now();
            const auto frame = pictures_.draw(request);
            const Milliseconds taken = Clock::now() - start;
            if (!frame.ok())
                return fabric::withContext(frame.status(),
                                           fmt::format("second {:.3f} of the flight", key.seconds));
            fabric::FrameStatistics statistics = frame->statistics;
            statistics.tauAchievedPixels *=
                static_cast<double>(request.width) / frame->image.area.width;
            played_.frames.push_back({pass, key.seconds, taken.count(), std::move(statistics)});
            played_.device = frame->device;
            drawing += taken.count();
            frameDone_();
        }
        if (pass > 0) {
            drawing_ += drawing;
            all_ += Milliseconds(Clock::now() - begin).count();
        }
        return absl::OkStatus();
    }

    double overheadPercent() const { return drawing_ > 0 ? 100 * (all_ / drawing_ - 1) : 0; }

private:
    PictureSource& pictures_;
    const std::function<void()>& frameDone_;
    const std::stop_token& stop_;
    Played& played_;
    double drawing_ = 0;  ///< milliseconds of the measured passes, of their frames
    double all_ = 0;      ///< and of all that was done
};

}  // namespace

absl::StatusOr<Played> play(PictureSource& pictures, const fabric::Flight& flight,
                            const PlayOptions& options, const std::function<void()>& frameDone,
                            const std::stop_token& stop) {
    ASSIGN_OR_RETURN(const auto frames, framesOf(flight, options.frames));
    Played played;
    Pass passes(pictures, frameDone, stop, played);
    played.frames.reserve(frames.size() * static_cast<std::size_t>(options.repeats + 1));
    resetPeakResidentBytes();
    for (int pass = 0; pass <= options.repeats; ++pass) {
        RETURN_IF_ERROR(passes.play(pass, frames, options.request));
        if (pass == 0 && std::ranges::none_of(played.frames, showsSomething))
            return nothingSeen(pictures.sceneInfo().bounds);
    }
    played.overheadPercent = passes.overheadPercent();
    played.peakResidentBytes = peakResidentBytes();
    coordinator::FrameRequest request = options.request;
    request.measuresStages = true;
    ASSIGN_OR_RETURN(const auto measured,
                     framesOf(flight, std::min(options.frames, kMeasuredFrames)));
    for (const fabric::FlightKey& key : measured) {
        if (stop.stop_requested())
            return absl::CancelledError("stopped; nothing was written");
        request.camera = key.camera;
        ASSIGN_OR_RETURN(const coordinator::RenderedFrame frame, pictures.draw(request));
        played.stages.push_back(frame.statistics.milliseconds);
    }
    return played;
}

}  // namespace eyrie::cli::bench
