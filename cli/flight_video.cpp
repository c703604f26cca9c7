// SPDX-License-Identifier: Apache-2.0
#include "cli/flight_video.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/flights.h"
#include "cli/bound_text.h"
#include "cli/log.h"
#include "cli/output_reader.h"
#include "cli/picture_bands.h"
#include "cli/progress_bar.h"
#include "coordinator/stream/home_camera.h"
#include "fabric/status.h"
#include "renderer/mesh/output_file.h"
#include "video/load.h"

namespace eyrie::cli {
namespace {

constexpr std::array<std::string_view, 3> kEndings = {"mp4", "mkv", "webm"};
/// An hour at 60 frames a second.
constexpr double kMostFrames = 216'000;

std::string endingOf(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    return dot == std::string::npos ? "" : path.substr(dot + 1);
}

absl::StatusOr<std::vector<fabric::FlightKey>> framesFor(const FlightVideo& video,
                                                         const fabric::Box& bounds) {
    ASSIGN_OR_RETURN(const fabric::CameraPath path, video.flight.over(bounds));
    if (!video.quiet && !path.note.empty())
        tell(fmt::format("{}: {}", video.flight.name(), path.note));
    const fabric::Flight& flight = path.flight;
    const double count = std::round(flight.seconds() * video.framesPerSecond) + 1;
    if (count > kMostFrames)
        return absl::InvalidArgumentError(fmt::format(
            "--flight takes {} seconds, {:.0f} pictures at --fps {}; at most {:.0f} are "
            "drawn",
            flight.seconds(), count, video.framesPerSecond, kMostFrames));
    return bench::framesOf(flight, static_cast<int>(count));
}

/// What became of the pictures of one video.
struct Drawn {
    double worstPixels = 0;
    std::size_t empty = 0;
    std::string whyEmpty = {};  ///< coordinator::whyEmpty() of the last that is
    std::size_t incomplete = 0;

    void add(const coordinator::RenderedFrame& frame) {
        worstPixels = std::max(worstPixels, frame.statistics.tauAchievedPixels);
        incomplete += frame.statistics.complete ? 0 : 1;
        if (const std::string why = coordinator::whyEmpty(frame); !why.empty()) {
            ++empty;
            whyEmpty = why;
        }
    }
};

void tellOf(const Drawn& drawn, std::size_t count, const std::string& out, double tauPixels) {
    if (drawn.empty > 0)
        tell(fmt::format("{}: {} of {} pictures are empty. {}", out, drawn.empty, count,
                         drawn.whyEmpty));
    if (drawn.incomplete > 0)
        tell(fmt::format("{}: {} of {} pictures are incomplete", out, drawn.incomplete, count));
    tell(fmt::format(
        "{}: {} pictures, error at most {} of {:.3g} pixels asked, and what coding adds", out,
        count, boundText(drawn.worstPixels), tauPixels));
}

}  // namespace

bool isVideoName(const std::string& path) {
    return std::ranges::find(kEndings, endingOf(path)) != kEndings.end();
}

absl::Status writeFlightVideo(const FlightVideo& video, const std::string& scene,
                              const PictureSourceOptions& pictures,
                              const coordinator::FrameRequest& request,
                              const std::stop_token& stop) {
    if (!isVideoName(video.out))
        return absl::InvalidArgumentError(
            fmt::format("-o {}: a flight is written as .mp4, .mkv or .webm", video.out));
    ASSIGN_OR_RETURN(const video::Module* module, video::load());
    ASSIGN_OR_RETURN(const OutputReader reader, OutputReader::await(video.out, stop));
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(video.out));
    const auto [width, height] = wholeSize(request);
    ASSIGN_OR_RETURN(
        const auto movie,
        module->makeMovie({endingOf(video.out), width, height, video.framesPerSecond},
                          [&file](std::uint64_t offset, std::span<const std::byte> bytes) {
                              return file.writeAt(offset, bytes);
                          }));
    ASSIGN_OR_RETURN(const auto source, PictureSource::open(scene, pictures, stop));
    ASSIGN_OR_RETURN(const auto frames,
                     framesFor(video, stream::exaggeratedBounds(source->sceneInfo(),
                                                                request.look.exaggeration)));
    ProgressBar bar(video.out, static_cast<double>(frames.size()), "pictures",
                    ProgressBar::styleFor(video.quiet));
    coordinator::FrameRequest asked = request;
    Drawn drawn;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (stop.stop_requested())
            return absl::CancelledError("stopped; nothing was written");
        asked.camera = frames[i].camera;
        ASSIGN_OR_RETURN(const coordinator::RenderedFrame frame, source->draw(asked));
        drawn.add(frame);
        RETURN_IF_ERROR(movie->add(frame.image));
        bar.show("drawing", static_cast<double>(i + 1) / static_cast<double>(frames.size()),
                 ProgressBar::Clock::now());
    }
    RETURN_IF_ERROR(movie->finish());
    RETURN_IF_ERROR(file.commit());
    if (!video.quiet)
        tellOf(drawn, frames.size(), video.out, request.tauPixels);
    return absl::OkStatus();
}

}  // namespace eyrie::cli
