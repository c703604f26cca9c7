// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/tiles.h"

#include <fmt/format.h>

namespace eyrie::equalizer {
namespace {

void set(std::vector<config::Tiles>& queues, const std::string& name,
         const std::optional<config::Tiles>& tiles) {
    std::erase_if(queues, [&](const config::Tiles& each) { return each.name == name; });
    if (tiles)
        queues.push_back(*tiles);
}

}  // namespace

Tiles::Tiles(const config::Equalizer& equalizer, const config::Compound& written,
             std::size_t position, const Work& work)
    : position_(position),
      work_(work),
      name_(!equalizer.name.empty() ? equalizer.name
            : !written.name.empty() ? "queue." + written.name
                                    : fmt::format("queue.{}", position)) {
    for (const config::Compound& child : written.children)
        written_.push_back({child.viewport, child.range, false});
}

void Tiles::apply(Turn& turn, const config::Equalizer& settings, bool) {
    config::Tiles tiles;
    tiles.name = name_;
    if (settings.tileChunk)
        tiles.chunk = settings.tileChunk;
    else
        tiles.size = settings.tileSize;
    set(turn, tiles);
    for (const std::size_t child : work_.at(position_).children) {
        turn.live[child]->viewport = {};
        turn.live[child]->range = {};
    }
    isOn_ = true;
}

void Tiles::switchOff(Turn& turn) {
    if (!isOn_)
        return;
    isOn_ = false;
    set(turn, std::nullopt);
    const std::vector<std::size_t>& children = work_.at(position_).children;
    for (std::size_t i = 0; i < children.size(); ++i) {
        turn.live[children[i]]->viewport = written_[i].viewport;
        turn.live[children[i]]->range = written_[i].range;
    }
}

void Tiles::set(Turn& turn, const std::optional<config::Tiles>& tiles) const {
    equalizer::set(turn.live[position_]->outputTiles, name_, tiles);
    for (std::size_t p = position_; p < work_.at(position_).end; ++p)
        if (work_.at(p).drawsItself)
            equalizer::set(turn.live[p]->inputTiles, name_, tiles);
}

}  // namespace eyrie::equalizer
