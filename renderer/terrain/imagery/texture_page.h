// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/terrain/imagery/bc1.h"

namespace eyrie::terrain {

/// One texture tile, decoded: its blocks row by row, border included (TexturePyramid::texels).
/// Owns its blocks; immutable, so shared freely between threads.
///
/// On disk the blocks lie apart by what they hold: red, green and blue of the first colours, each
/// as the difference from what the blocks to the left and above let expect, those of the second
/// colours as the difference from the first, and the four rows of choices. Each of these ten planes
/// is a block of its own in a frame of zstd, so that each has its own table of symbols.
class TexturePage {
public:
    /// Precondition: blocks.size() is a multiple of blocksX.
    static std::vector<std::byte> encode(std::span<const Bc1Block> blocks, std::int32_t blocksX);

    /// Whatever the bytes are, nothing leads out of bounds and no more than the blocks asked for
    /// and their planes is held. Errors: DataLoss. `name` is used in messages only.
    /// Precondition: blocksX, blocksY >= 1.
    static absl::StatusOr<TexturePage> decode(std::span<const std::byte> bytes,
                                              std::int32_t blocksX, std::int32_t blocksY,
                                              const std::string& name);

    std::span<const Bc1Block> blocks() const { return blocks_; }
    std::int32_t blocksX() const { return blocksX_; }
    std::int32_t blocksY() const { return static_cast<std::int32_t>(blocks_.size()) / blocksX_; }
    std::size_t sizeBytes() const { return blocks_.size() * sizeof(Bc1Block); }

private:
    TexturePage(std::vector<Bc1Block> blocks, std::int32_t blocksX)
        : blocks_(std::move(blocks)), blocksX_(blocksX) {}

    std::vector<Bc1Block> blocks_;
    std::int32_t blocksX_;
};

}  // namespace eyrie::terrain
