// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/queues.h"

#include <algorithm>

namespace eyrie::compound {
namespace {

using equalizer::TileQueue;

TileQueue queueOf(const QueueMaker& maker) {
    if (maker.tiles->chunk)
        return TileQueue::ofRange(maker.area, maker.range,
                                  std::max(*maker.tiles->chunk, 1.0 / kMostTiles));
    const auto most = static_cast<double>(fabric::kMaxViewPixels);
    const fabric::Vec2 size = maker.tiles->size.value_or(config::Equalizer{}.tileSize);
    auto width = static_cast<std::int32_t>(std::clamp(size.x, 1.0, most));
    auto height = static_cast<std::int32_t>(std::clamp(size.y, 1.0, most));
    while (TileQueue::ofPicture(maker.area, width, height).size() > kMostTiles) {
        width *= 2;
        height *= 2;
    }
    return TileQueue::ofPicture(maker.area, width, height);
}

std::vector<equalizer::Tile> tilesOf(const QueueMaker& maker) {
    std::vector<equalizer::Tile> tiles;
    const TileQueue queue = queueOf(maker);
    for (std::int64_t i = 0; i < queue.size(); ++i) tiles.push_back(queue.tile(i));
    return tiles;
}

}  // namespace

std::map<std::size_t, QueueShare> queueShares(const std::vector<QueueMaker>& makers,
                                              const std::vector<QueueTaker>& takers,
                                              WorkList& list) {
    std::map<std::size_t, QueueShare> shares;
    for (const QueueMaker& maker : makers) {
        std::vector<const QueueTaker*> own;
        for (const QueueTaker& taker : takers)
            if (taker.name == maker.tiles->name && taker.destination == maker.destination &&
                taker.lattice == maker.lattice && !shares.contains(taker.compound))
                own.push_back(&taker);
        if (own.empty())
            continue;
        const std::vector<equalizer::Tile> tiles = tilesOf(maker);
        std::vector<config::ChannelIndex> channels;
        for (std::size_t i = 0; i < own.size(); ++i) {
            const auto at = [&](std::size_t k) {
                return tiles.begin() + static_cast<std::ptrdiff_t>(tiles.size() * k / own.size());
            };
            shares[own[i]->compound] = {
                list.queues.size(), maker.area, {at(i), at(i + 1)}, maker.tiles->chunk.has_value()};
            if (std::ranges::find(channels, own[i]->channel) == channels.end())
                channels.push_back(own[i]->channel);
        }
        list.queues.push_back(std::move(channels));
    }
    return shares;
}

}  // namespace eyrie::compound
