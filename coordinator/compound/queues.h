// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string_view>
#include <vector>

#include "coordinator/compound/equalizer/tile_queue.h"
#include "coordinator/compound/work.h"

/// Queues of tiles, and of chunks of the range: what Equalizer's outputtiles make, and whoever of
/// those with inputtiles is free takes. A frame's plan does not know who that will be. Since all
/// draw the same, it says for each tile in whose framebuffer it is put together, and leaves open
/// which renderer draws it.
namespace eyrie::compound {

/// A compound with outputtiles.
struct QueueMaker {
    const config::Tiles* tiles = nullptr;
    std::size_t destination = 0;
    Lattice lattice;
    fabric::PixelViewport area;  ///< of its framebuffer
    fabric::Range range;
};

/// A compound that draws, with inputtiles.
struct QueueTaker {
    std::size_t compound = 0;
    std::string_view name;  ///< of the queue
    config::ChannelIndex channel;
    std::size_t destination = 0;
    Lattice lattice;
};

/// What is put together in a taker's framebuffer, of what all of them draw.
struct QueueShare {
    std::size_t queue = 0;       ///< in WorkList::queues
    fabric::PixelViewport area;  ///< of all of the queue, in place of the taker's own
    std::vector<equalizer::Tile> tiles;
    bool isOfRange = false;  ///< chunks
};

/// By compound. Shares are neighbours, so that those of the range have no gaps. A taker of another
/// picture, or of other pixels of it, than the maker's has none: it draws its part by itself.
/// A queue has at most kMostTiles: smaller ones are doubled until they are as few.
std::map<std::size_t, QueueShare> queueShares(const std::vector<QueueMaker>& makers,
                                              const std::vector<QueueTaker>& takers,
                                              WorkList& list);
inline constexpr std::int64_t kMostTiles = 1024;

}  // namespace eyrie::compound
