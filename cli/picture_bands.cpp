// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_bands.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/frame/frame_sequence.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

/// What is drawn from the top down before the next is.
struct Pass {
    coordinator::Shown shown;
    int bottom = 0;  ///< in the whole picture
};

/// Two eyes one above the other come one after the other.
std::vector<Pass> passesOf(const coordinator::FrameRequest& request) {
    const coordinator::Shown& shown = request.shown.front();
    if (shown.eyesUp() == 1)
        return {{shown}};
    Pass left{shown, request.height};
    left.shown.stereo = compound::Stereo::Configured;
    left.shown.eye = compound::Eye::Left;
    Pass right{left.shown};
    right.shown.eye = compound::Eye::Right;
    return {left, right};
}

/// Adds what another band did, which was drawn after those before.
void accumulateNext(fabric::FrameStatistics& sum, const fabric::FrameStatistics& band) {
    const fabric::StageMilliseconds before = sum.milliseconds;
    fabric::accumulate(sum, band);
    fabric::StageMilliseconds& ms = sum.milliseconds;
    const auto add = [&](double fabric::StageMilliseconds::*stage) {
        ms.*stage = before.*stage + band.milliseconds.*stage;
    };
    for (const auto stage :
         {&fabric::StageMilliseconds::cull, &fabric::StageMilliseconds::draw,
          &fabric::StageMilliseconds::readback, &fabric::StageMilliseconds::encode,
          &fabric::StageMilliseconds::total, &fabric::StageMilliseconds::vertices,
          &fabric::StageMilliseconds::fill})
        add(stage);
}

}  // namespace

PictureSize wholeSize(const coordinator::FrameRequest& request) {
    const coordinator::Shown& shown = request.shown.front();
    return {request.width * shown.eyesAcross(), request.height * shown.eyesUp()};
}

absl::StatusOr<DrawnBands> drawInBands(
    PictureSource& pictures, const coordinator::FrameRequest& request, std::int64_t bandPixels,
    const std::function<absl::Status(const fabric::Image&)>& take) {
    DrawnBands drawn;
    const int most =
        static_cast<int>(std::clamp<std::int64_t>(bandPixels / request.width, 1, request.height));
    bool isFirst = true;
    const std::vector<Pass> passes = passesOf(request);
    const auto bandsOfPass = static_cast<std::size_t>((request.height + most - 1) / most);
    coordinator::FrameSequence bands;
    bands.atOnce = pictures.framesAtOnce();
    bands.draw = [&](const auto& choose) { return pictures.drawLatest(choose); };
    bands.view = [&](std::size_t index) -> std::optional<coordinator::FrameRequest> {
        if (index >= passes.size() * bandsOfPass)
            return std::nullopt;
        const int end = request.height - static_cast<int>(index % bandsOfPass) * most;
        coordinator::FrameRequest band = request;
        band.shown = {passes[index / bandsOfPass].shown};
        band.part = {0, std::max(end - most, 0), request.width, std::min(end, most)};
        return band;
    };
    bands.take = [&](coordinator::FrameSequence::Frame band) {
        RETURN_IF_ERROR(band.drawn.status());
        accumulateNext(drawn.statistics, band.drawn->statistics);
        drawn.device = band.drawn->device;
        if (drawn.whyBlind.empty())
            drawn.whyBlind = coordinator::whyBlind(*band.drawn);
        const std::string why = coordinator::whyEmpty(*band.drawn);
        if (std::exchange(isFirst, false) || why.empty())
            drawn.whyEmpty = why;
        fabric::Image& rows = band.drawn->image;
        rows.area.y += passes[band.index / bandsOfPass].bottom;
        return take(rows);
    };
    RETURN_IF_ERROR(coordinator::drawSequence(bands));
    return drawn;
}

}  // namespace eyrie::cli
