// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/flight_judge.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/play.h"
#include "cli/bench/shown_triangles.h"
#include "fabric/depth_metres.h"
#include "fabric/status.h"
#include "renderer/truth/flip.h"
#include "renderer/truth/heat_map.h"
#include "renderer/truth/image_quality.h"
#include "renderer/truth/silhouette.h"
#include "wire/png.h"

namespace eyrie::cli::bench {
namespace {

/// An outline may have moved by as much as everything else.
int edgePixels(double promisedPixels, const truth::Pinhole& camera) {
    return static_cast<int>(
        std::min<double>(std::ceil(promisedPixels) + 1, std::max(camera.width(), camera.height())));
}

std::string bytesOf(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Binary digits mirrored at the point: 1/2, 1/4, 3/4, 1/8, ... of 1, 2, 3, 4, ... (van der Corput,
/// "Verteilungsfunktionen", 1935).
double radicalInverse(int index) {
    double value = 0;
    for (double digit = 0.5; index > 0; index /= 2, digit /= 2) value += digit * (index % 2);
    return value;
}

/// Where in its part of the flight a frame is judged, 0 to 1. An even stride may be in step with
/// what a flight repeats, as the shots of `worst`; it is off the halves, where these change.
double placeInPart(int part) { return std::fmod(radicalInverse(part + 1) + 1.0 / 16, 1); }

/// What a frame's surface may be off.
double allowedPixels(const FrameError& error) {
    return error.promisedPixels + kRasterPixels * error.stretch;
}

/// How near to its promise, or how far beyond: what makes a frame worth looking at. Of one that is
/// empty less than that of any other; of one that breaks its promise, by holes as well, more than
/// that of any that keeps it.
double share(const FrameError& error) {
    if (isEmpty(error))
        return -1;
    const double share = error.maxPixels / allowedPixels(error);
    return keepsPromise(error) ? share : std::max(share, 1.0) + 1;
}

}  // namespace

bool hasWrongPixels(const FrameError& error) {
    return error.falseHits != 0 ||
           (!error.mayHaveSeams && (error.holes != 0 || error.misplaced != 0));
}

bool keepsPromise(const FrameError& error) {
    return error.maxPixels <= allowedPixels(error) && !hasWrongPixels(error);
}

std::vector<int> judgedFrames(const JudgedFrames& frames) {
    const int judged = std::min(frames.judged, frames.played);
    std::vector<int> indices;
    for (int i = 0; i < judged; ++i) {
        const int first = i * frames.played / judged;
        const int count = (i + 1) * frames.played / judged - first;
        indices.push_back(first + static_cast<int>(placeInPart(i) * count));
    }
    return indices;
}

std::uint64_t neededBytes(const JudgedFrames& frames) {
    constexpr std::uint64_t kExpected = 20;
    constexpr std::uint64_t kPicture = 8;
    constexpr std::uint64_t kInWork = 130;
    const auto pixels =
        static_cast<std::uint64_t>(frames.width) * static_cast<std::uint64_t>(frames.height);
    const auto judged = static_cast<std::uint64_t>(std::min(frames.judged, frames.played));
    const auto runs = static_cast<std::uint64_t>(frames.keptRuns);
    return pixels * (judged * (kExpected + runs * kPicture) + kInWork);
}

FlightJudge::FlightJudge(ReferenceScene reference, const fabric::Flight& flight,
                         const JudgedFrames& frames, page::SourceOptions remote)
    : reference_(std::move(reference)), how_(frames), remote_(std::move(remote)) {
    for (const int played : judgedFrames(frames)) {
        const double seconds =
            frames.played == 1 ? 0 : flight.seconds() * played / (frames.played - 1);
        frames_.push_back({seconds, flight.at(seconds), {}});
    }
}

std::vector<fabric::Camera> FlightJudge::cameras() const {
    std::vector<fabric::Camera> cameras;
    for (const Frame& frame : frames_) cameras.push_back(frame.camera);
    return cameras;
}

absl::StatusOr<FlightJudge::Expected> FlightJudge::expect(PictureSource& finest,
                                                          coordinator::FrameRequest request) const {
    request.tauPixels = how_.finestTauPixels;
    ASSIGN_OR_RETURN(coordinator::RenderedFrame drawn, finest.draw(request));
    return Expected{truth::castView(truth::Pinhole(request.camera, request.width, request.height),
                                    *reference_.surface),
                    std::move(drawn.image)};
}

absl::StatusOr<FlightJudge::Judged> FlightJudge::judge(
    Frame& frame, coordinator::RenderedFrame drawn, PictureSource& finest,
    const coordinator::FrameRequest& request) const {
    const fabric::PixelViewport& area = drawn.image.area;
    if (drawn.image.depth.size() != static_cast<std::size_t>(area.area()))
        return absl::InternalError(
            fmt::format("a picture of {} x {} pixels came with {} depths, of which each has one",
                        area.width, area.height, drawn.image.depth.size()));
    const auto& budget = drawn.statistics.budget;
    const double tauPixels = budget ? budget->tauPixels : request.tauPixels;
    coordinator::FrameRequest expected = request;
    expected.width = area.width;
    expected.height = area.height;
    if (area.width != how_.width || area.height != how_.height) {
        ASSIGN_OR_RETURN(const Expected smaller, expect(finest, expected));
        return judge(frame, smaller, std::move(drawn), tauPixels);
    }
    if (!frame.expected) {
        ASSIGN_OR_RETURN(frame.expected, expect(finest, expected));
    }
    return judge(frame, *frame.expected, std::move(drawn), tauPixels);
}

FlightJudge::Judged FlightJudge::judge(const Frame& frame, const Expected& expected,
                                       coordinator::RenderedFrame drawn, double tauPixels) const {
    const truth::Pinhole& camera = expected.view.camera;
    const std::vector<float> depth = fabric::depthMetres(drawn.image);
    const double promised = drawn.statistics.tauAchievedPixels;
    const double stretched =
        stretch({drawn.image.area.width, drawn.image.area.height}, how_.width, how_.height);
    ShownTriangles shown(reference_, camera,
                         lod::View(frame.camera, camera.width(), camera.height()), tauPixels,
                         remote_);
    truth::Suspects suspects{promised + kRasterPixels, {}};
    const bool isOfOneCut = drawn.statistics.complete && !drawn.statistics.memoryRaisedTau;
    if (isOfOneCut)
        suspects.shown = [&](double x, double y, double metres) { return shown.at(x, y, metres); };
    Judged result;
    const truth::DepthComparison found =
        truth::compareDepth(expected.view, depth, edgePixels(promised, camera), suspects,
                            truth::LookAround::Farthest, &result.displacements);
    result.error = {.seconds = frame.seconds,
                    .promisedPixels = stretched * promised,
                    .p50Pixels = stretched * found.p50Pixels,
                    .p99Pixels = stretched * found.p99Pixels,
                    .maxPixels = stretched * found.maxPixels,
                    .compared = found.compared,
                    .holes = found.holes,
                    .falseHits = found.falseHits,
                    .misplaced = found.misplaced,
                    .silhouettePixels = stretched * truth::silhouettePixels(expected.view, depth),
                    .psnrDb = truth::psnrDb(expected.finest, drawn.image),
                    .ssim = truth::ssim(expected.finest, drawn.image),
                    .flip = truth::meanFlip(expected.finest, drawn.image),
                    .triangles = drawn.statistics.triangles + drawn.statistics.points,
                    .drawnTauPixels = tauPixels,
                    .stretch = stretched,
                    .complete = drawn.statistics.complete,
                    .mayHaveSeams = !isOfOneCut && drawn.parts.size() > 1};
    result.picture = std::move(drawn.image);
    return result;
}

absl::StatusOr<MeasuredErrors> FlightJudge::judge(PictureSource& pictures, PictureSource& finest,
                                                  coordinator::FrameRequest request,
                                                  const std::function<void()>& frameDone,
                                                  const std::stop_token& stop) {
    const Draw draw = [&](std::size_t, coordinator::FrameRequest asked) {
        asked.wantsDepth = true;
        return pictures.draw(asked);
    };
    return judgeAll(draw, finest, std::move(request), frameDone, stop);
}

absl::StatusOr<MeasuredErrors> FlightJudge::judge(std::vector<coordinator::RenderedFrame> shown,
                                                  PictureSource& finest,
                                                  coordinator::FrameRequest request,
                                                  const std::function<void()>& frameDone,
                                                  const std::stop_token& stop) {
    const Draw draw = [&](std::size_t i, const coordinator::FrameRequest&) {
        return std::move(shown.at(i));
    };
    return judgeAll(draw, finest, std::move(request), frameDone, stop);
}

absl::StatusOr<MeasuredErrors> FlightJudge::judgeAll(const Draw& draw, PictureSource& finest,
                                                     coordinator::FrameRequest request,
                                                     const std::function<void()>& frameDone,
                                                     const std::stop_token& stop) {
    MeasuredErrors measured;
    std::optional<Judged> worst;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        if (stop.stop_requested())
            return absl::CancelledError("stopped; nothing was written");
        Frame& frame = frames_[i];
        request.camera = frame.camera;
        const auto drawAndJudge = [&]() -> absl::StatusOr<Judged> {
            ASSIGN_OR_RETURN(coordinator::RenderedFrame drawn, draw(i, request));
            return judge(frame, std::move(drawn), finest, request);
        };
        absl::StatusOr<Judged> judged = drawAndJudge();
        if (!judged.ok())
            return fabric::withContext(judged.status(),
                                       fmt::format("second {:.3f} of the flight", frame.seconds));
        measured.frames.push_back(judged->error);
        if (!worst || share(judged->error) > share(worst->error))
            worst = *std::move(judged);
        frameDone();
    }
    if (!worst)
        return measured;
    // A scale of its own tau: pictures of one run are alike.
    const fabric::PixelViewport& area = worst->picture.area;
    ASSIGN_OR_RETURN(const auto picture, wire::encodePng(worst->picture));
    ASSIGN_OR_RETURN(const auto heat,
                     wire::encodePng(truth::heatMap(worst->displacements, area.width, area.height,
                                                    worst->error.drawnTauPixels)));
    measured.worst.push_back({worst->error, bytesOf(picture), bytesOf(heat)});
    return measured;
}

}  // namespace eyrie::cli::bench
