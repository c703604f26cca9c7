// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_bands.h"

#include <algorithm>

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
    for (int top = request.height; top > 0;) {
        const int rows = std::min(top, most);
        top -= rows;
        coordinator::FrameRequest band = request;
        band.part = {0, top, request.width, rows};
        ASSIGN_OR_RETURN(const coordinator::RenderedFrame frame, pictures.draw(band));
        accumulateNext(drawn.statistics, frame.statistics);
        drawn.device = frame.device;
        RETURN_IF_ERROR(take(frame.image));
    }
    return drawn;
}

}  // namespace eyrie::cli
