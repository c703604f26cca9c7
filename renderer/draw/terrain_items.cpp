// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_items.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "renderer/terrain/tile_bytes.h"

namespace eyrie::draw {

using terrain::Quadtree;
using terrain::TextureId;
using terrain::TileId;

TerrainItem TerrainItems::of(const TileId& tile) const {
    return {index_.quadtree.tileIndex(tile), index_.quadtree.pageIndex(tile),
            terrain::estimatedTileBytes(index_, tile)};
}

TerrainItem TerrainItems::of(const TextureId& texture) const {
    const terrain::TexturePyramid& pyramid = index_.imagery->pyramid;
    const std::uint32_t number = pyramid.tileIndex(texture);
    return {index_.quadtree.tileCount() + number, index_.quadtree.pageCount() + number,
            textureBytes(pyramid, texture, format_)};
}

std::uint64_t TerrainItems::bytesOnDisk(std::uint32_t page) const {
    return isTexture(page) ? index_.imagery->tiles[page - index_.quadtree.pageCount()].bytes
                           : index_.pages[page].bytes;
}

std::uint64_t TerrainItems::greatestPageBytes(std::uint32_t page) const {
    return isTexture(page) ? textureBytes(index_.imagery->pyramid, textureOf(page), format_)
                           : terrain::greatestPageBytes(index_, page);
}

std::uint64_t TerrainItems::greatestOfAllPages() const {
    std::uint64_t most = 0;
    for (std::uint32_t page = 0; page < index_.quadtree.pageCount(); ++page)
        most = std::max(most, greatestPageBytes(page));
    if (index_.imagery)  // a tile of the finest level is as large as any
        most = std::max(most, greatestPageBytes(index_.quadtree.pageCount()));
    return most;
}

/// A page's tiles take no more on the device than its own bound. On the host as much again is for
/// pages that are being loaded (HostPages).
MemoryUse TerrainItems::greatestUse() const {
    const std::uint32_t textures =
        index_.imagery ? static_cast<std::uint32_t>(index_.imagery->tiles.size()) : 0;
    std::uint64_t all = 0;
    for (std::uint32_t page = 0; page < index_.quadtree.pageCount() + textures; ++page)
        if (bytesOnDisk(page) > 0)
            all += greatestPageBytes(page);
    return {all, 2 * (all + greatestOfAllPages())};
}

/// As high as the smallest tile that holds all of it and draws anything.
fabric::Box TerrainItems::boundsOf(const TextureId& texture) const {
    const double side = index_.imagery->pyramid.sidePosts(texture.level);
    const TileId top = index_.quadtree.top();
    int level = 0;
    while (level < top.level && Quadtree::side(level) < side) ++level;
    const double tiles = side / Quadtree::side(level);
    TileId tile{level, static_cast<std::int32_t>(texture.x * tiles),
                static_cast<std::int32_t>(texture.y * tiles)};
    while (tile != top && index_.tile(tile).triangles == 0) tile = Quadtree::parent(tile);
    const terrain::TileRecord& ground = index_.tile(tile);
    const double x1 = std::min(side * (texture.x + 1), index_.quadtree.columns() - 1.0);
    const double y1 = std::min(side * (texture.y + 1), index_.quadtree.rows() - 1.0);
    fabric::Box box;
    for (const double x : {side * texture.x, x1})
        for (const double y : {side * texture.y, y1}) {
            const fabric::Vec3 corner(index_.objectFromLattice * fabric::Vec4(x, y, 0, 1));
            box.grow({corner.x, corner.y, ground.minHeightMetres});
            box.grow({corner.x, corner.y, ground.maxHeightMetres});
        }
    return box;
}

std::vector<TerrainItem> TerrainItems::inOrder(const std::vector<TileId>& tiles,
                                               const std::vector<TextureId>& textures,
                                               const lod::ObjectView& view) const {
    struct Scored {
        TerrainItem item;
        double sidePosts;
        double score;
    };
    std::vector<Scored> scored;
    scored.reserve(tiles.size() + textures.size());
    const auto add = [&](const TerrainItem& item, double sidePosts, const fabric::Box& bounds,
                         double offMetres) {
        constexpr double kMostPixels = 1e4;  // where no bound is finite, the middle first
        const fabric::PixelViewport covered = view.coveredPixels(bounds);
        const double x = (covered.x + 0.5 * covered.width) / view.view().width - 0.5;
        const double y = (covered.y + 0.5 * covered.height) / view.view().height - 0.5;
        const double pixels = std::min(view.screenSpaceErrorPixels(offMetres, bounds), kMostPixels);
        scored.push_back({item, sidePosts, pixels / (0.1 + x * x + y * y)});
    };
    for (const TileId& tile : tiles) {
        const TileId standIn = tile == index_.quadtree.top() ? tile : Quadtree::parent(tile);
        add(of(tile), Quadtree::side(tile.level), index_.bounds(tile),
            index_.tile(standIn).greatestErrorMetres());
    }
    const double postMetres = std::max(glm::length(fabric::Vec3(index_.objectFromLattice[0])),
                                       glm::length(fabric::Vec3(index_.objectFromLattice[1])));
    for (const TextureId& texture : textures) {
        const terrain::TexturePyramid& pyramid = index_.imagery->pyramid;
        const double texelPosts = pyramid.texelPosts(texture.level + 1);
        add(of(texture), pyramid.sidePosts(texture.level), boundsOf(texture),
            texelPosts * postMetres);
    }
    std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) {
        return a.sidePosts != b.sidePosts ? a.sidePosts > b.sidePosts : a.score > b.score;
    });
    std::vector<TerrainItem> items;
    items.reserve(scored.size());
    for (const Scored& one : scored) items.push_back(one.item);
    return items;
}

}  // namespace eyrie::draw
