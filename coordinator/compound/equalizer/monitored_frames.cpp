// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/monitored_frames.h"

#include <algorithm>

#include <glm/common.hpp>

namespace eyrie::equalizer {
namespace {

using Zooms = std::vector<std::optional<fabric::Vec2>>;

/// An input frame by which a compound takes an output frame.
struct Taker {
    std::size_t position = 0;
    std::size_t input = 0;
    fabric::Vec2 zoom;  ///< that the output frame is to have for it
};

void giveZooms(const Zooms& zooms, std::vector<config::Frame>& frames) {
    for (std::size_t i = 0; i < std::min(zooms.size(), frames.size()); ++i)
        frames[i].zoom = zooms[i];
}

/// The frame's for who takes it so: for a monitor at work what that says, for others `written`.
fabric::Vec2 zoomFor(const Turn& turn, const MonitoredFrame& frame, std::size_t position,
                     std::size_t input, const fabric::Vec2& written) {
    const auto found = std::ranges::find_if(turn.monitored, [&](const MonitoredFrame& each) {
        return each.source == frame.source && each.output == frame.output &&
               each.monitor == position && each.input == input;
    });
    return found == turn.monitored.end() ? written : found->zoom;
}

/// Those of the frame's tree.
std::vector<Taker> takersOf(const Turn& turn, const MonitoredFrame& frame) {
    const config::ResolvedCompound& source = *turn.resolved(frame.source);
    const std::string& name = source.outputFrames[frame.output].name;
    const fabric::Vec2 written =
        turn.work.at(frame.source).outputZooms[frame.output].value_or(fabric::Vec2(1, 1));
    std::size_t root = frame.source;
    while (root > 0 && turn.resolved(root)->depth > 0) --root;
    std::vector<Taker> takers;
    for (std::size_t p = root; p < turn.work.at(root).end; ++p) {
        const config::ResolvedCompound* const compound = turn.resolved(p);
        if (compound == nullptr || !compound->tasks.assemble || !meet(source, *compound) ||
            !turn.isAskedFor(*compound))
            continue;
        for (std::size_t i = 0; i < compound->inputFrames.size(); ++i)
            if (compound->inputFrames[i].name == name)
                takers.push_back({p, i, zoomFor(turn, frame, p, i, written)});
    }
    return takers;
}

void zoom(Turn& turn, const MonitoredFrame& frame) {
    const std::vector<Taker> takers = takersOf(turn, frame);
    if (takers.empty())
        return;
    fabric::Vec2 most = takers.front().zoom;
    for (const Taker& each : takers) most = glm::max(most, each.zoom);
    turn.live[frame.source]->outputFrames[frame.output].zoom = most;
    for (const Taker& each : takers)
        if (const auto written = turn.work.at(each.position).inputZooms[each.input])
            turn.live[each.position]->inputFrames[each.input].zoom = *written * (each.zoom / most);
}

}  // namespace

void zoomMonitoredFrames(Turn& turn) {
    for (std::size_t p = 0; p < turn.live.size(); ++p) {
        giveZooms(turn.work.at(p).outputZooms, turn.live[p]->outputFrames);
        giveZooms(turn.work.at(p).inputZooms, turn.live[p]->inputFrames);
    }
    for (const MonitoredFrame& each : turn.monitored) zoom(turn, each);
}

}  // namespace eyrie::equalizer
