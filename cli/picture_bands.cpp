// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_bands.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "coordinator/frame/frame_sequence.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

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

absl::StatusOr<DrawnBands> drawInBands(
    PictureSource& pictures, const coordinator::FrameRequest& request, std::int64_t bandPixels,
    const std::function<absl::Status(const fabric::Image&)>& take) {
    DrawnBands drawn;
    const int most =
        static_cast<int>(std::clamp<std::int64_t>(bandPixels / request.width, 1, request.height));
    bool isFirst = true;
    coordinator::FrameSequence bands;
    bands.atOnce = pictures.framesAtOnce();
    bands.draw = [&](const auto& choose) { return pictures.drawLatest(choose); };
    bands.view = [&](std::size_t index) -> std::optional<coordinator::FrameRequest> {
        const std::int64_t top = request.height - static_cast<std::int64_t>(index) * most;
        if (top <= 0)
            return std::nullopt;
        const auto end = static_cast<std::int32_t>(top);
        coordinator::FrameRequest band = request;
        band.part = {0, std::max(end - most, 0), request.width, std::min(end, most)};
        return band;
    };
    bands.take = [&](const coordinator::FrameSequence::Frame& band) {
        RETURN_IF_ERROR(band.drawn.status());
        accumulateNext(drawn.statistics, band.drawn->statistics);
        drawn.device = band.drawn->device;
        const std::string_view why = coordinator::whyEmpty(*band.drawn);
        if (std::exchange(isFirst, false) || why.empty())
            drawn.whyEmpty = why;
        return take(band.drawn->image);
    };
    RETURN_IF_ERROR(coordinator::drawSequence(bands));
    return drawn;
}

}  // namespace eyrie::cli
