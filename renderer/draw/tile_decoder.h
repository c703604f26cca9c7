// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "effects/tile_decode_effect.h"
#include "renderer/gl/object.h"

namespace eyrie::draw {

/// Makes tiles' vertices and indices on the device, from outlines (terrain::PageForm::Outlines):
/// what terrain::PageForm::Drawable holds, bit for bit. GL thread.
class TileDecoder {
public:
    /// FailedPrecondition where the driver cannot run it.
    static absl::StatusOr<TileDecoder> create();

    /// Has `tile`, a buffer of `bytes`, filled with the tile's words and then its indices, rounded
    /// up to 4 bytes: by publish(), before which it may not go. `outline` is one that a page holds,
    /// and is copied.
    void decode(std::span<const std::uint32_t> outline, const gl::Buffer& tile, std::size_t bytes);

    /// Makes the tiles of all outlines since the last time, side by side: one alone would leave
    /// most of a GPU idle. Does not wait; what is drawn or read back from here on sees them.
    void publish();

private:
    /// As the shader has it; in words.
    struct Place {
        std::uint32_t outline;
        std::uint32_t tile;
        std::uint32_t tileWords;
    };

    explicit TileDecoder(effects::TileDecodeEffect effect);

    effects::TileDecodeEffect effect_;
    gl::Buffer scratch_;
    std::vector<Place> places_;
    std::vector<GLuint> tiles_;  ///< of each place
    std::vector<std::uint32_t> outlines_;
    std::size_t madeWords_ = 0;
};

}  // namespace eyrie::draw
