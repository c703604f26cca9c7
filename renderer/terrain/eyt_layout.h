// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "renderer/terrain/quadtree.h"

/// The bytes of an .eyt file, version 1; little-endian throughout.
///
///   FileHeader
///   pages, each a PageHeader and the arrays its tiles name, padded to 4 bytes
///   index at FileHeader::indexOffset: CRS as WKT (crsBytes, padded to 8), then a TileRecord for
///   every tile of the quadtree, then (at a multiple of 8) a PageRecord for every page
///
/// Tiles and pages are counted as Quadtree does. All offsets in a page are from its start.
namespace eyrie::terrain {

static_assert(std::endian::native == std::endian::little, "pages are used as they lie on disk");

inline constexpr std::array<char, 8> kEytMagic = {'E', 'Y', 'R', 'I', 'E', 'E', 'Y', 'T'};
inline constexpr std::uint32_t kEytVersion = 1;
inline constexpr std::uint64_t kMaxCrsBytes = 1 << 20;
inline constexpr std::int32_t kMaxHeightSteps = 1 << 23;  ///< of |q|

struct FileHeader {
    std::array<char, 8> magic = kEytMagic;
    std::uint32_t version = kEytVersion;
    std::uint32_t levels = 0;
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::array<double, 16> objectFromLattice{};  ///< column by column
    std::uint64_t sourceHash = 0;
    std::uint64_t nodataPosts = 0;
    std::uint64_t indexOffset = 0;
    std::uint64_t indexBytes = 0;
    std::uint64_t crsBytes = 0;
    std::uint64_t indexChecksum = 0;   ///< XXH64 of the index
    std::uint64_t headerChecksum = 0;  ///< XXH64 of all header bytes before this one
};
static_assert(sizeof(FileHeader) == 208 && std::is_trivially_copyable_v<FileHeader>);

/// What a page says of one tile. All zero: the tile has no triangles.
struct TileHeader {
    std::uint32_t wordsOffset = 0;
    std::uint32_t indicesOffset = 0;
    std::uint32_t normalsOffset = 0;
    std::uint32_t vertices = 0;
    std::uint16_t wordsPerVertex = 0;
    std::uint16_t cells = 0;  ///< Quadtree::cells of the level
    std::int32_t baseHeight = 0;
    std::int32_t heightMultiplier = 0;
    std::array<std::uint32_t, 9> indexCounts{};  ///< of each part
};
static_assert(sizeof(TileHeader) == 64 && std::is_trivially_copyable_v<TileHeader>);

using PageHeader = std::array<TileHeader, static_cast<std::size_t>(kPageTiles) * kPageTiles>;

inline std::uint64_t roundUp(std::uint64_t value, std::uint64_t multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

}  // namespace eyrie::terrain
