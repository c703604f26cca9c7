// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/tile_queue.h"

#include <algorithm>
#include <cmath>

namespace eyrie::equalizer {

TileQueue TileQueue::ofPicture(const fabric::PixelViewport& whole, std::int32_t tileWidth,
                               std::int32_t tileHeight) {
    TileQueue queue(whole, {});
    queue.tileWidth_ = std::max(tileWidth, 1);
    queue.tileHeight_ = std::max(tileHeight, 1);
    if (whole.isEmpty())
        return queue;
    queue.columns_ = (whole.width - 1) / queue.tileWidth_ + 1;
    queue.rows_ = (whole.height - 1) / queue.tileHeight_ + 1;
    return queue;
}

TileQueue TileQueue::ofRange(const fabric::PixelViewport& picture, const fabric::Range& whole,
                             double chunk) {
    TileQueue queue(picture, whole);
    if (picture.isEmpty() || whole.isEmpty())
        return queue;
    queue.chunk_ = std::clamp(chunk > 0 ? chunk : 1.0, 1.0 / kMostChunks, 1.0);
    queue.columns_ = static_cast<std::int64_t>(std::ceil(1 / queue.chunk_ - 1e-9));
    queue.rows_ = 1;
    return queue;
}

Tile TileQueue::tile(std::int64_t index) const {
    if (tileWidth_ == 0) {
        const double size = range_.end - range_.begin;
        const auto at = [&](std::int64_t i) {
            return i == columns_ ? range_.end
                                 : range_.begin + size * chunk_ * static_cast<double>(i);
        };
        return {index, picture_, {at(index), at(index + 1)}};
    }
    const std::int64_t row = index / columns_;
    const std::int64_t along = index % columns_;
    const std::int64_t column = row % 2 == 0 ? along : columns_ - 1 - along;
    const auto x = static_cast<std::int32_t>(column * tileWidth_);
    const auto y = static_cast<std::int32_t>(row * tileHeight_);
    return {index,
            {picture_.x + x, picture_.y + y, std::min(tileWidth_, picture_.width - x),
             std::min(tileHeight_, picture_.height - y)},
            range_};
}

}  // namespace eyrie::equalizer
