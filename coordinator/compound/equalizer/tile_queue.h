// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "fabric/range.h"
#include "fabric/viewport.h"

namespace eyrie::equalizer {

/// A piece of a picture, or of its data, that whoever is free draws.
struct Tile {
    std::int64_t index = 0;
    fabric::PixelViewport pixelViewport;
    fabric::Range range;

    bool operator==(const Tile&) const = default;
};

/// The tiles of one frame, or the chunks of its range, in the order in which they are handed out to
/// whoever is free: where nobody knows what they will take, none waits for long. Tiles go row by
/// row from below, each second row backwards, so that neighbours follow each other and share what
/// is loaded.
class TileQueue {
public:
    /// Tiles of `tileWidth` x `tileHeight` from the lower left corner, the last ones of rows and
    /// columns with what is left; sizes below 1 count as 1.
    static TileQueue ofPicture(const fabric::PixelViewport& whole, std::int32_t tileWidth,
                               std::int32_t tileHeight);
    /// Chunks of `chunk` of `whole`, each for all of `picture`; the last has what is left. At
    /// most kMostChunks.
    static TileQueue ofRange(const fabric::PixelViewport& picture, const fabric::Range& whole,
                             double chunk);
    static constexpr std::int64_t kMostChunks = 4096;

    std::int64_t size() const { return columns_ * rows_; }

    /// `index` from 0 to below size().
    Tile tile(std::int64_t index) const;

private:
    TileQueue(const fabric::PixelViewport& picture, const fabric::Range& range)
        : picture_(picture), range_(range) {}

    fabric::PixelViewport picture_;
    fabric::Range range_;
    std::int32_t tileWidth_ = 0;  ///< 0: chunks
    std::int32_t tileHeight_ = 0;
    double chunk_ = 1;
    std::int64_t columns_ = 0;
    std::int64_t rows_ = 0;
};

}  // namespace eyrie::equalizer
