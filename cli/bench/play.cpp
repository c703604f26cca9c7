// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/play.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/flights.h"
#include "cli/bench/resident_memory.h"
#include "coordinator/frame/eye_sides.h"
#include "coordinator/frame/frame_sequence.h"
#include "coordinator/frame/problem.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

absl::Status nothingSeen(const fabric::Box& bounds) {
    const std::string ofSize = coordinator::noteOfSize(bounds);
    return absl::InvalidArgumentError(
        fmt::format("no frame of the flight shows anything of the scene, which lies between "
                    "({}, {}, {}) and ({}, {}, {}); {}",
                    bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y,
                    bounds.max.z, ofSize.empty() ? "fly where the data are" : ofSize));
}

/// Errors in pixels of the size asked for.
fabric::FrameStatistics ofSizeAskedFor(const coordinator::RenderedFrame& drawn,
                                       const coordinator::FrameRequest& asked) {
    const fabric::PictureSides sides = coordinator::sidesOfEye(asked, drawn.image.area);
    const double stretched = stretch(sides, asked.width, asked.height);
    fabric::FrameStatistics statistics = drawn.statistics;
    statistics.tauAchievedPixels = statistics.tauAchievedPixels * stretched +
                                   fabric::shapeErrorPixels(asked.width, asked.height, sides);
    if (statistics.budget)
        statistics.budget->tauPixels *= stretched;
    return statistics;
}

/// Whether something was drawn, since all of an anaglyph may differ from the background, and some
/// pixel is not the background's. From the middle of the picture on, where that is known at once of
/// most: it is within the time that the bench takes.
bool showsSomething(const coordinator::RenderedFrame& drawn, const fabric::Rgba& background) {
    if (drawn.statistics.nodes + drawn.statistics.nodesHidden == 0)
        return false;
    const auto isOther = [&](const fabric::Rgba& pixel) { return pixel != background; };
    const auto& pixels = drawn.image.colour;
    const auto middle = pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() / 2);
    return std::any_of(middle, pixels.end(), isOther) ||
           std::any_of(pixels.begin(), middle, isOther);
}

/// A pass over the flight's frames; their pictures are timed, and nothing else.
class Pass {
public:
    Pass(PictureSource& pictures, const std::function<void()>& frameDone,
         const std::stop_token& stop, Played& played)
        : pictures_(pictures), frameDone_(frameDone), stop_(stop), played_(played) {}

    absl::Status play(int pass, const std::vector<fabric::FlightKey>& frames,
                      coordinator::FrameRequest request) {
        auto last = Clock::now();
        double drawing = 0;
        double taking = 0;
        coordinator::FrameSequence sequence = along(frames, request, {});
        sequence.take = [&](const coordinator::FrameSequence::Frame& frame) {
            const double seconds = frames[frame.index].seconds;
            RETURN_IF_ERROR(check(frame, seconds));
            const Milliseconds latency = frame.arrived - frame.begun;
            const Milliseconds interval = frame.arrived - std::exchange(last, frame.arrived);
            const Milliseconds taken = sequence.atOnce == 1 ? latency : interval;
            const double stretched =
                stretch(coordinator::sidesOfEye(request, frame.drawn->image.area), request.width,
                        request.height);
            played_.frames.push_back(
                {pass, seconds, taken.count(), ofSizeAskedFor(*frame.drawn, request),
                 latency.count(), stretched, showsSomething(*frame.drawn, pictures_.background())});
            played_.device = frame.drawn->device;
            drawing += taken.count();
            frameDone_();
            taking += Milliseconds(Clock::now() - frame.arrived).count();
            return absl::OkStatus();
        };
        RETURN_IF_ERROR(coordinator::drawSequence(sequence));
        if (pass > 0) {
            drawing_ += drawing;
            taking_ += taking;
        }
        played_.framesInFlight = sequence.atOnce;
        return absl::OkStatus();
    }

    /// A pass that nothing is measured of: pictures and depths of the frames `keeps` are kept.
    absl::Status keep(const std::vector<int>& keeps, const std::vector<fabric::FlightKey>& frames,
                      coordinator::FrameRequest request) {
        coordinator::FrameSequence sequence = along(frames, request, keeps);
        sequence.take = [&](coordinator::FrameSequence::Frame frame) {
            RETURN_IF_ERROR(check(frame, frames[frame.index].seconds));
            if (std::ranges::binary_search(keeps, static_cast<int>(frame.index)))
                played_.kept.push_back(*std::move(frame.drawn));
            frameDone_();
            return absl::OkStatus();
        };
        return coordinator::drawSequence(sequence);
    }

    double overheadPercent() const { return drawing_ > 0 ? 100 * taking_ / drawing_ : 0; }

private:
    /// All of `frames`, as many at once as there can be; of those in `withDepth`, depths, too.
    coordinator::FrameSequence along(const std::vector<fabric::FlightKey>& frames,
                                     coordinator::FrameRequest& request,
                                     std::vector<int> withDepth) {
        coordinator::FrameSequence sequence;
        sequence.atOnce = pictures_.framesAtOnce();
        sequence.draw = [this](const auto& choose) { return pictures_.drawLatest(choose); };
        sequence.view = [&frames, &request, withDepth = std::move(withDepth)](
                            std::size_t index) -> std::optional<coordinator::FrameRequest> {
            if (index == frames.size())
                return std::nullopt;
            request.camera = frames[index].camera;
            request.wantsDepth = std::ranges::binary_search(withDepth, static_cast<int>(index));
            return request;
        };
        return sequence;
    }

    absl::Status check(const coordinator::FrameSequence::Frame& frame, double seconds) const {
        if (stop_.stop_requested())
            return absl::CancelledError("stopped; nothing was written");
        if (!frame.drawn.ok())
            return fabric::withContext(frame.drawn.status(),
                                       fmt::format("second {:.3f} of the flight", seconds));
        return absl::OkStatus();
    }

    PictureSource& pictures_;
    const std::function<void()>& frameDone_;
    const std::stop_token& stop_;
    Played& played_;
    double drawing_ = 0;  ///< milliseconds of the measured passes, of their frames
    double taking_ = 0;   ///< and of what was done with these
};

}  // namespace

std::uint64_t keptBytes(const Played& played) {
    std::uint64_t sum = 0;
    for (const coordinator::RenderedFrame& frame : played.kept)
        sum += frame.image.colour.size() * sizeof(fabric::Rgba) +
               frame.image.depth.size() * sizeof(float);
    return sum;
}

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
        if (pass == 0 && std::ranges::none_of(played.frames, &PlayedFrame::showsSomething))
            return nothingSeen(pictures.sceneInfo().bounds);
    }
    played.overheadPercent = passes.overheadPercent();
    played.peakResidentBytes = peakResidentBytes();
    if (!options.keeps.empty())
        RETURN_IF_ERROR(passes.keep(options.keeps, frames, options.request));
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
