// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/overlaps.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace eyrie::config {
namespace {

bool haveAnEyeInCommon(const Eyes& a, const Eyes& b) {
    return (a.cyclop && b.cyclop) || (a.left && b.left) || (a.right && b.right);
}

/// Of a view that is shown, where on the canvas.
auto placeOf(const Destination& shown, const Viewport& segment) {
    const DestinationIndex& index = shown.index;
    return std::tuple(index.canvas, index.layout, index.view, segment.x, segment.y, segment.width,
                      segment.height);
}

}  // namespace

void noteOverlaps(const Configuration& configuration, const ResolvedConfiguration& resolved,
                  Findings& findings) {
    using Where = decltype(placeOf(Destination(), Viewport()));
    std::map<Where, std::vector<const Destination*>> shown;
    std::set<std::size_t> noted;  // canvases
    for (const Destination& each : resolved.destinations) {
        const std::vector<Segment>& segments = configuration.canvases[each.index.canvas].segments;
        if (noted.contains(each.index.canvas))
            continue;
        std::vector<const Destination*>& there =
            shown[placeOf(each, segments[each.index.segment].viewport)];
        const auto below = std::ranges::find_if(there, [&](const Destination* other) {
            return haveAnEyeInCommon(other->eyes, each.eyes);
        });
        if (below == there.end()) {
            there.push_back(&each);
            continue;
        }
        noted.insert(each.index.canvas);
        findings.note(segments[(*below)->index.segment].place,
                      "another segment of the canvas takes the same place: one picture of the "
                      "whole canvas shows the last of them; each has a picture of its own (`eyrie "
                      "render --all`, or `&segment=` in the page's address)");
    }
}

}  // namespace eyrie::config
