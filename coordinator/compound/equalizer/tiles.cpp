// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/tiles.h"

#include <algorithm>

#include <fmt/format.h>

namespace eyrie::equalizer {
namespace {

void set(std::vector<config::Tiles>& queues, const std::string& name,
         const std::optional<config::Tiles>& tiles) {
    std::erase_if(queues, [&](const config::Tiles& each) { return each.name == name; });
    if (tiles)
        queues.push_back(*tiles);
}

/// What a compound reads back has background around its own tiles, which would cover others'.
void addTakers(const config::Compound& compound, std::size_t position, const Work& work,
               std::vector<std::size_t>& takers) {
    if (work.at(position).drawsItself)
        takers.push_back(position);
    const std::vector<std::size_t>& children = work.at(position).children;
    for (std::size_t i = 0; i < children.size(); ++i)
        if (work.at(children[i]).drawsItself || compound.children[i].outputFrames.empty())
            addTakers(compound.children[i], children[i], work, takers);
}

}  // namespace

Tiles::Tiles(const config::Compound& written, std::size_t position, const Work& work)
    : position_(position), work_(work), name_(fmt::format("tile_equalizer.{}", position)) {
    addTakers(written, position, work, takers_);
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
        if (!hasTakers(child))
            continue;
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
    for (const std::size_t taker : takers_)
        equalizer::set(turn.live[taker]->inputTiles, name_, tiles);
}

bool Tiles::hasTakers(std::size_t child) const {
    return std::ranges::any_of(
        takers_, [&](std::size_t taker) { return taker >= child && taker < work_.at(child).end; });
}

}  // namespace eyrie::equalizer
