// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_ahead.h"

#include <algorithm>
#include <cstddef>

#include <glm/geometric.hpp>

namespace eyrie::draw {
namespace {

using terrain::Quadtree;
using terrain::TextureId;
using terrain::TileId;

/// For Prefetch::nodes.
struct TileTree {
    using Node = TileId;

    const terrain::EytIndex& index;

    Node root() const { return index.quadtree.top(); }
    fabric::Box bounds(const Node& tile) const { return index.bounds(tile); }
    double errorMetres(const Node& tile) const { return index.tile(tile).greatestErrorMetres(); }
    template <typename Visit>
    void forEachChild(const Node& tile, const Visit& visit) const {
        for (int i = 0; i < 4 && tile.level > 0; ++i)
            if (const Node child = Quadtree::child(tile, i);
                index.quadtree.contains(child) && index.tile(child).triangles > 0)
                visit(child);
    }
};

/// For Prefetch::nodes, with texels for tau: a texel is to pictures what its error is to the
/// ground.
struct TextureTree {
    using Node = TextureId;

    const terrain::ImageryIndex& imagery;
    const TerrainItems& items;
    double postMetres;

    Node root() const { return imagery.pyramid.top(); }
    fabric::Box bounds(const Node& texture) const { return items.boundsOf(texture); }
    double errorMetres(const Node& texture) const {
        return postMetres * imagery.pyramid.texelPosts(texture.level);
    }
    template <typename Visit>
    void forEachChild(const Node& texture, const Visit& visit) const {
        for (int i = 0; i < 4; ++i)
            if (const Node child{texture.level - 1, 2 * texture.x + (i & 1),
                                 2 * texture.y + (i >> 1)};
                imagery.pyramid.contains(child) && imagery.has(child))
                visit(child);
    }
};

}  // namespace

std::vector<TerrainItem> itemsAhead(const Prefetch& prefetch, const terrain::EytIndex& index,
                                    const TerrainItems& items, double tauPixels, double texelPixels,
                                    std::chrono::duration<double> latency) {
    const std::vector<TileId> tiles = prefetch.nodes(TileTree{index}, tauPixels, latency);
    std::vector<TextureId> textures;
    if (index.imagery) {
        const double postMetres = std::max(glm::length(fabric::Vec3(index.objectFromLattice[0])),
                                           glm::length(fabric::Vec3(index.objectFromLattice[1])));
        textures =
            prefetch.nodes(TextureTree{*index.imagery, items, postMetres}, texelPixels, latency);
    }
    std::vector<TerrainItem> ahead;
    std::size_t next = 1;  // behind the top one
    const auto addTextures = [&](double leastSidePosts) {
        for (; next < textures.size() &&
               index.imagery->pyramid.sidePosts(textures[next].level) > leastSidePosts;
             ++next)
            ahead.push_back(items.of(textures[next]));
    };
    for (std::size_t i = 1; i < tiles.size(); ++i) {
        addTextures(Quadtree::side(tiles[i].level));
        ahead.push_back(items.of(tiles[i]));
    }
    addTextures(0);
    return ahead;
}

}  // namespace eyrie::draw
