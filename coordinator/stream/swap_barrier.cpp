// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/swap_barrier.h"

#include "coordinator/config/named.h"

namespace eyrie::stream {
namespace {

struct Named {
    std::string name;
};

}  // namespace

std::string swapBarrierOf(const std::vector<coordinator::CanvasStatus>& canvases,
                          const coordinator::Shown& shown) {
    if (canvases.empty())
        return "";
    const auto canvas = shown.canvas.empty() ? absl::StatusOr<std::size_t>(0)
                                             : config::findNamed(canvases, "canvas", shown.canvas);
    if (!canvas.ok())
        return "";
    const coordinator::CanvasStatus& seen = canvases[*canvas];
    if (shown.segment.empty())
        return seen.barriers.whole;
    std::vector<Named> segments;
    for (const std::string& name : seen.segments) segments.push_back({name});
    const auto segment = config::findNamed(segments, "segment", shown.segment);
    return segment.ok() && *segment < seen.barriers.segments.size()
               ? seen.barriers.segments[*segment]
               : "";
}

}  // namespace eyrie::stream
