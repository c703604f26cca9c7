// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderer/codec/symbol_shares.h"
#include "renderer/terrain/quadtree.h"

/// Lossless coding of a page's normals.
///
/// x is foreseen from its three neighbours before it (M. Weinberger, G. Seroussi, G. Sapiro, "The
/// LOCO-I Lossless Image Compression Algorithm", 2000: the median edge detector). y is foreseen
/// from x: normals lean as a surface's slopes, and slopes have no curl, so central differences obey
///   y(i + 1, j) - y(i - 1, j) = x(i, j + 1) - x(i, j - 1)
/// but for rounding, the length of the normal and posts that are not square. What is left is
/// entropy-coded in the context of what was left above it.
namespace eyrie::terrain {

/// What is left of a row above says which of these contexts a sample has.
inline constexpr std::size_t kNormalContexts = 4;

/// A row with room for a copy of its ends on both sides.
inline constexpr std::size_t kPaddedRow = kMaxTileCells + 3;

/// Collects tiles, each (cells + 1)^2 samples as TileGeometry::normals describes. For one page
/// after the other.
class NormalEncoder {
public:
    /// All tiles of a page have the same number of cells.
    void add(std::int32_t cells, std::span<const std::int8_t> normals);
    /// Starts over.
    std::vector<std::uint8_t> finish();

private:
    void addPlane(std::size_t firstContext);

    std::size_t samples_ = 0;             ///< a side
    std::vector<std::uint8_t> symbols_;   ///< plane by plane, row by row
    std::vector<std::uint8_t> contexts_;  ///< alike
    std::vector<std::int8_t> x_;          ///< of the tile being added
    std::vector<std::int8_t> y_;
    std::vector<std::uint8_t> left_;  ///< residuals of one of the two
};

/// Reads what NormalEncoder wrote, tile by tile in the same order; safe on any bits.
class NormalDecoder {
public:
    NormalDecoder(std::span<const std::uint8_t> bytes, std::int32_t cells);

    /// Reads what the tiles share, first of all. False: the bits are impossible.
    bool begin();
    /// Precondition: normals.size() == 2 * (cells + 1)^2. False: the bits have ended.
    bool decode(std::span<std::int8_t> normals);
    /// Whether all bits were used, after the last tile.
    bool isAtEnd() const { return rans_.isAtEnd(); }

private:
    void decodePlane(std::size_t firstContext, std::uint8_t* left);

    std::size_t samples_;
    std::span<const std::uint8_t> bytes_;
    codec::RansDecoder<4> rans_;
    std::vector<std::uint32_t> slots_;  ///< of each context of x and y in turn
    std::vector<std::uint8_t> left_;    ///< one plane of residuals
    std::vector<std::int8_t> x_;
    std::vector<std::int8_t> y_;
};

}  // namespace eyrie::terrain
