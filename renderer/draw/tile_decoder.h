// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

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

    /// Fills `tile`, a buffer of the tile's words and then its indices, rounded up to 4 bytes. Does
    /// not wait; what is drawn or read back afterwards sees it. `outline` is one that a page holds.
    void decode(std::span<const std::uint32_t> outline, const gl::Buffer& tile) const;

private:
    explicit TileDecoder(effects::TileDecodeEffect effect);

    effects::TileDecodeEffect effect_;
    gl::Buffer scratch_;
};

}  // namespace eyrie::draw
