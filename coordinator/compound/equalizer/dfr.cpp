// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/dfr.h"

#include <algorithm>
#include <cmath>

#include "coordinator/config/destinations.h"
#include "coordinator/config/equalizer_limits.h"
#include "fabric/channel_task.h"

namespace eyrie::equalizer {
namespace {

constexpr double kLeastPixels = 128;
/// A frame that took next to nothing does not say how many more pixels it could have had.
constexpr double kMostAtOnce = 2;

/// How many pixels of a side the channel that draws has for each of `shown`. That of the
/// destination is as large as what is shown.
double roomOf(const Turn& turn, std::size_t position, const fabric::Vec2& shown) {
    const config::ResolvedConfiguration& resolved = turn.facts.resolved;
    const config::ChannelIndex destination =
        resolved.destinations[*resolved.compounds[position].destination].channel;
    double room = 1;
    for (std::size_t p = position; p < turn.work.at(position).end; ++p) {
        const config::ResolvedCompound* const each = turn.resolved(p);
        if (!turn.work.at(p).drawsItself || each == nullptr || !each->channel ||
            each->channel == destination)
            continue;
        const fabric::PixelViewport pixels = config::pixelsOf(turn.configuration, *each->channel);
        room = std::max(room, std::min(pixels.width / shown.x, pixels.height / shown.y));
    }
    return room;
}

}  // namespace

Dfr::Dfr(const config::Compound& written, std::size_t position, const Work& work)
    : position_(position), work_(work), written_(written.zoom) {}

void Dfr::apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) {
    const config::ResolvedCompound* const compound = turn.resolved(position_);
    if (compound == nullptr)
        return;
    if (milliseconds_ > 0 && !isFrozen) {
        const double ratio = framesPerSecond_ / settings.framerate;
        const double goal = itsZoom_ * std::min(std::sqrt(ratio), kMostAtOnce);
        zoom_ += settings.damping * (goal - zoom_);
        milliseconds_ = 0;
    }
    const fabric::Vec2 shown(compound->pixelViewport.width, compound->pixelViewport.height);
    const double shorter = std::min(shown.x, shown.y);
    if (!compound->destination || !(shorter > 0) || !std::isfinite(shorter))
        return;
    const double least = std::min(1.0, kLeastPixels / shorter);
    double most = std::min({roomOf(turn, position_, shown),
                            fabric::kMaxViewPixels / std::max(shown.x, shown.y),
                            config::kMostZoom / std::max(written_.x, written_.y)});
    // Where every n-th pixel is drawn, more pixels than those would lie outside the view.
    if (compound->pixel != config::PixelShare{})
        most = std::min(most, std::max(1.0, 1 / std::max(written_.x, written_.y)));
    zoom_ = std::clamp(zoom_, least, std::max(least, most));
    turn.live[position_]->zoom = turn.facts.isComplete ? written_ : written_ * zoom_;
}

void Dfr::switchOff(Turn& turn) {
    turn.live[position_]->zoom = written_;
    zoom_ = 1;
    milliseconds_ = 0;
    framesPerSecond_ = 0;
}

void Dfr::record(const PlannedFrame& frame, const FrameTimes& times) {
    if (frame.isComplete)
        return;
    milliseconds_ = work_.longest(position_, frame, times);
    if (milliseconds_ > 0 && position_ < times.compounds.size())
        milliseconds_ += known(times.compounds[position_].assemble).value_or(0);
    if (milliseconds_ > 0) {
        framesPerSecond_ = 1000 / milliseconds_;
        itsZoom_ = frame.parts[position_].zoom.x / written_.x;
    }
}

Report Dfr::report() const { return {.framesPerSecond = framesPerSecond_, .zoom = zoom_}; }

}  // namespace eyrie::equalizer
