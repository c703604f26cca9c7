// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/terrain/imagery/texture_pyramid.h"
#include "renderer/terrain/page_record.h"
#include "renderer/terrain/quadtree.h"

namespace eyrie::terrain {

/// What an .eyt says of its imagery; always resident.
struct ImageryIndex {
    TexturePyramid pyramid;
    /// Of the finest level against what BC1 was made of: 10 log10(255² / mean square error) over
    /// the covered texels' red, green and blue. Infinite where nothing was lost.
    double psnrDb = 0;
    std::uint64_t coveredTexels = 0;  ///< of the finest level
    std::vector<PageRecord> tiles;    ///< by pyramid.tileIndex; of 0 bytes: all of it is a hole

    bool has(const TextureId& tile) const { return tiles[pyramid.tileIndex(tile)].bytes != 0; }
    /// Of the finest level, holes included.
    std::uint64_t finestTexels() const {
        return static_cast<std::uint64_t>(pyramid.width(0)) *
               static_cast<std::uint64_t>(pyramid.height(0));
    }
};

/// The same for people.
struct ImagerySummary {
    std::uint64_t columns = 0;  ///< texels of the finest level
    std::uint64_t rows = 0;
    std::uint64_t coveredTexels = 0;
    std::uint64_t bytes = 0;  ///< of all levels, on disk
    double psnrDb = 0;
};
ImagerySummary summaryOf(const ImageryIndex& imagery);

/// The bytes at the end of an .eyt's index: an ImageryHeader and a PageRecord for every tile.
std::vector<std::byte> bytesOf(const ImageryIndex& imagery);

/// What the records of so many bytes of bytesOf take in memory.
std::uint64_t recordBytes(std::uint64_t imageryBytes);

/// What bytesOf wrote. `pagesEnd` is the byte of the file that all pages lie before.
/// Errors: DataLoss. `name` is used in messages only.
absl::StatusOr<ImageryIndex> imageryFrom(std::span<const std::byte> bytes, const Quadtree& quadtree,
                                         std::uint64_t pagesEnd, const std::string& name);

}  // namespace eyrie::terrain
