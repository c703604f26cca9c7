// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "fabric/box.h"
#include "renderer/draw/device_texture.h"
#include "renderer/draw/drawable.h"
#include "renderer/lod/view.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// Something of a terrain that is brought to the device as a whole: a tile or a texture tile.
struct TerrainItem {
    std::uint32_t key = 0;          ///< distinct among all items of a terrain
    std::uint32_t page = 0;         ///< what has to be read for it
    std::uint64_t deviceBytes = 0;  ///< about
};

/// Names and sizes of a terrain's items and pages. Texture tiles have the keys and pages after
/// those of tiles, and each is a page of its own. Immutable.
class TerrainItems {
public:
    /// Keeps a reference to `index`.
    TerrainItems(const terrain::EytIndex& index, TextureFormat format)
        : index_(index), format_(format) {}

    TerrainItem of(const terrain::TileId& tile) const;
    /// Precondition: the terrain has imagery.
    TerrainItem of(const terrain::TextureId& texture) const;

    bool isTexture(std::uint32_t page) const { return page >= index_.quadtree.pageCount(); }
    /// Precondition: isTexture(page).
    terrain::TextureId textureOf(std::uint32_t page) const {
        return index_.imagery->pyramid.tileOf(page - index_.quadtree.pageCount());
    }
    /// 0: there is nothing in it.
    std::uint64_t bytesOnDisk(std::uint32_t page) const;
    /// Of memory on the host, at most.
    std::uint64_t greatestPageBytes(std::uint32_t page) const;
    std::uint64_t greatestOfAllPages() const;
    /// What the terrain may take with all of it in memory, at most.
    MemoryUse greatestUse() const;
    TextureFormat format() const { return format_; }

    /// Large ones on the ground first; among equals by how many pixels what stands in for them is
    /// off, a tile by its error and a texture tile by its texels, and by nearness to the view's
    /// axis.
    std::vector<TerrainItem> inOrder(const std::vector<terrain::TileId>& tiles,
                                     const std::vector<terrain::TextureId>& textures,
                                     const lod::ObjectView& view) const;

    /// Of the ground below it.
    fabric::Box boundsOf(const terrain::TextureId& texture) const;

private:
    const terrain::EytIndex& index_;
    TextureFormat format_;
};

}  // namespace eyrie::draw
