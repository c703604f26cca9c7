// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "renderer/terrain/quadtree.h"

/// The bytes of an .eyt file, version 6; little-endian throughout.
///
///   FileHeader
///   pages, each a PageHeader, `words` (uint16) and `raw` bytes of the geometry, the bytes of the
///   normals, and zeros up to a multiple of 4
///   index at FileHeader::indexOffset: CRS as WKT (crsBytes, padded to 8), then a TileRecord for
///   every tile of the quadtree, then (at a multiple of 8) a PageRecord for every page, then, of a
///   terrain with imagery, what imagery/imagery_index.h says; its texture tiles lie among the pages
///
/// Tiles and pages are counted as Quadtree does. codec/ describes the bits of geometry and normals.
namespace eyrie::terrain {

static_assert(std::endian::native == std::endian::little, "pages are used as they lie on disk");

inline constexpr std::array<char, 8> kEytMagic = {'E', 'Y', 'R', 'I', 'E', 'E', 'Y', 'T'};
inline constexpr std::uint32_t kEytVersion = 6;
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

/// What a page says of one tile's geometry besides its bits. All zero: it has no triangles.
struct TileHeader {
    std::int32_t baseHeight = 0;  ///< q of height 0
    std::uint16_t vertices = 0;
    std::uint16_t triangles = 0;  ///< of all parts
    std::uint16_t limitX = 0;     ///< of TileShape
    std::uint16_t limitY = 0;
    std::uint8_t finerEdges = 0;
    std::uint8_t wordsPerVertex = 0;
    std::uint8_t heightShift = 0;  ///< TileGeometry::heightMultiplier is 1 << heightShift
    std::uint8_t isSparse = 0;     ///< 1: each point says whether it is a vertex at all
};
static_assert(sizeof(TileHeader) == 16 && std::is_trivially_copyable_v<TileHeader>);

struct PageHeader {
    std::uint32_t wordBytes = 0;
    std::uint32_t rawBytes = 0;
    std::uint32_t normalBytes = 0;
    std::uint16_t cells = 0;        ///< Quadtree::cells of the page's level
    std::uint16_t finerStep = 0;    ///< of TileShape
    std::uint32_t normalTiles = 0;  ///< bit of each place that has normals; none: no normalBytes
    std::array<TileHeader, static_cast<std::size_t>(kPageTiles) * kPageTiles> tiles;
};
static_assert(sizeof(PageHeader) == 276 && std::is_trivially_copyable_v<PageHeader>);

inline std::uint64_t roundUp(std::uint64_t value, std::uint64_t multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

}  // namespace eyrie::terrain
