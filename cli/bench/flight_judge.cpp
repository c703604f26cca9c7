// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/flight_judge.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/shown_triangles.h"
#include "cli/png_file.h"
#include "fabric/depth_metres.h"
#include "fabric/status.h"
#include "renderer/truth/flip.h"
#include "renderer/truth/heat_map.h"
#include "renderer/truth/image_quality.h"
#include "renderer/truth/silhouette.h"

namespace eyrie::cli::bench {
namespace {

constexpr double kRasterPixels = 1.0 / 256;

/// An outline may have moved by as much as everything else.
int edgePixels(double promisedPixels, const truth::Pinhole& camera) {
    return static_cast<int>(
        std::min<double>(std::ceil(promisedPixels) + 1, std::max(camera.width(), camera.height())));
}

std::string bytesOf(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// How near to its promise, or how far beyond: what makes a frame worth looking at.
double share(const FrameError& error) { return error.maxPixels / error.promisedPixels; }

}  // namespace

bool keepsPromise(const FrameError& error) {
    return error.maxPixels <= error.promisedPixels + kRasterPixels && error.holes == 0 &&
           error.falseHits == 0 && error.misplaced == 0;
}

std::uint64_t neededBytes(const JudgedFrames& frames) {
    constexpr std::uint64_t kKept = 20;
    constexpr std::uint64_t kInWork = 130;
    const auto pixels =
        static_cast<std::uint64_t>(frames.width) * static_cast<std::uint64_t>(frames.height);
    const auto kept = static_cast<std::uint64_t>(std::min(frames.judged, frames.played));
    return pixels * (kept * kKept + kInWork);
}

FlightJudge::FlightJudge(ReferenceScene reference, const fabric::Flight& flight,
                         const JudgedFrames& frames, page::SourceOptions remote)
    : reference_(std::move(reference)), how_(frames), remote_(std::move(remote)) {
    const int judged = std::min(frames.judged, frames.played);
    for (int i = 0; i < judged; ++i) {
        const int played = (2 * i + 1) * frames.played / (2 * judged);
        const double seconds =
            frames.played == 1 ? 0 : flight.seconds() * played / (frames.played - 1);
        frames_.push_back({seconds, flight.at(seconds), {}, {}});
    }
}

std::vector<fabric::Camera> FlightJudge::cameras() const {
    std::vector<fabric::Camera> cameras;
    for (const Frame& frame : frames_) cameras.push_back(frame.camera);
    return cameras;
}

absl::Status FlightJudge::prepare(Frame& frame, PictureSource& pictures,
                                  coordinator::FrameRequest request) const {
    if (frame.view)
        return absl::OkStatus();
    request.tauPixels = std::min(kFinestTauPixels, request.tauPixels);
    ASSIGN_OR_RETURN(coordinator::RenderedFrame finest, pictures.draw(request));
    frame.finest = std::move(finest.image);
    frame.view =
        truth::castView(truth::Pinhole(frame.camera, how_.width, how_.height), *reference_.surface);
    return absl::OkStatus();
}

absl::StatusOr<FlightJudge::Judged> FlightJudge::judge(Frame& frame, PictureSource& pictures,
                                                       coordinator::FrameRequest request) const {
    request.camera = frame.camera;
    RETURN_IF_ERROR(prepare(frame, pictures, request));
    request.wantsDepth = true;
    ASSIGN_OR_RETURN(coordinator::RenderedFrame drawn, pictures.draw(request));
    const double promised = drawn.statistics.tauAchievedPixels;
    if (drawn.image.depth.size() != frame.view->hits.size())
        return absl::InternalError(
            fmt::format("a picture of {} x {} pixels came with {} depths, of which each has one",
                        how_.width, how_.height, drawn.image.depth.size()));
    const std::vector<float> depth = fabric::depthMetres(drawn.image);
    ShownTriangles shown(reference_, frame.view->camera,
                         lod::View(frame.camera, how_.width, how_.height), request.tauPixels,
                         remote_);
    Judged result;
    const truth::DepthComparison found = truth::compareDepth(
        *frame.view, depth, edgePixels(promised, frame.view->camera),
        {promised + kRasterPixels,
         [&](double x, double y, double metres) { return shown.at(x, y, metres); }},
        truth::LookAround::Farthest, &result.displacements);
    result.error = {.seconds = frame.seconds,
                    .promisedPixels = promised,
                    .p50Pixels = found.p50Pixels,
                    .p99Pixels = found.p99Pixels,
                    .maxPixels = found.maxPixels,
                    .compared = found.compared,
                    .holes = found.holes,
                    .falseHits = found.falseHits,
                    .misplaced = found.misplaced,
                    .silhouettePixels = truth::silhouettePixels(*frame.view, depth),
                    .psnrDb = truth::psnrDb(*frame.finest, drawn.image),
                    .ssim = truth::ssim(*frame.finest, drawn.image),
                    .flip = truth::meanFlip(*frame.finest, drawn.image),
                    .triangles = drawn.statistics.triangles + drawn.statistics.points};
    result.picture = std::move(drawn.image);
    return result;
}

absl::StatusOr<MeasuredErrors> FlightJudge::judge(PictureSource& pictures,
                                                  coordinator::FrameRequest request,
                                                  const std::function<void()>& frameDone,
                                                  const std::stop_token& stop) {
    MeasuredErrors measured;
    std::optional<Judged> worst;
    for (Frame& frame : frames_) {
        if (stop.stop_requested())
            return absl::CancelledError("stopped; nothing was written");
        auto judged = judge(frame, pictures, request);
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
    ASSIGN_OR_RETURN(const auto picture, encodePng(worst->picture));
    ASSIGN_OR_RETURN(const auto heat, encodePng(truth::heatMap(worst->displacements, how_.width,
                                                               how_.height, request.tauPixels)));
    measured.worst.push_back({worst->error, bytesOf(picture), bytesOf(heat)});
    return measured;
}

}  // namespace eyrie::cli::bench
