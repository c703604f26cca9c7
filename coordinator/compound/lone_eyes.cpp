// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/lone_eyes.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "coordinator/compound/contents.h"
#include "coordinator/config/pixels.h"

namespace eyrie::compound {
namespace {

using config::Destination;

/// Of a layout.
using View = std::pair<std::size_t, std::size_t>;

View viewOf(const Destination& destination) {
    return {destination.index.layout, destination.index.view};
}

/// Which part of its canvas, and so of the layout, in thousandths: parts are written with few
/// digits.
fabric::PixelViewport placeOf(const Destination& destination,
                              const config::Configuration& configuration) {
    const config::DestinationIndex& index = destination.index;
    return config::part(
        fabric::PixelViewport{0, 0, 1000, 1000},
        intersection(configuration.canvases[index.canvas].segments[index.segment].viewport,
                     configuration.layouts[index.layout].views[index.view].viewport));
}

/// What is shown of a view.
struct Shown {
    Contents left;
    Contents right;
};

}  // namespace

void warnOfLoneEyes(const config::Configuration& configuration,
                    const config::ResolvedConfiguration& resolved, config::Findings& findings) {
    std::map<View, Shown> shown;
    for (const Destination& each : resolved.destinations) {
        const Content content{placeOf(each, configuration), {}, {}};
        if (each.eyes.left)
            shown[viewOf(each)].left.add(content);
        if (each.eyes.right)
            shown[viewOf(each)].right.add(content);
    }
    for (const Destination& each : resolved.destinations) {
        if (each.eyes.left == each.eyes.right)
            continue;
        const Shown& view = shown[viewOf(each)];
        const Contents& other = each.eyes.left ? view.right : view.left;
        if (other.cover(placeOf(each, configuration), {}))
            continue;
        const config::Segment& segment =
            configuration.canvases[each.index.canvas].segments[each.index.segment];
        findings.warning(segment.place,
                         fmt::format("the segment shows the view's eye {} where none shows the "
                                     "other's: in stereo that sees background there",
                                     each.eyes.left ? "LEFT" : "RIGHT"));
    }
}

}  // namespace eyrie::compound
