// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/tile_imagery.h"

#include <unordered_set>

namespace eyrie::draw {

using terrain::ImageryPart;
using terrain::Quadtree;
using terrain::TextureId;
using terrain::TexturePyramid;
using terrain::TileId;

std::vector<TextureId> TileImagery::texturesOf(std::span<const TileId> tiles,
                                               const lod::ObjectView& view,
                                               double texelPixels) const {
    std::vector<TextureId> textures;
    if (!index_.imagery)
        return textures;
    std::unordered_set<std::uint32_t> known{
        index_.imagery->pyramid.tileIndex(index_.imagery->pyramid.top())};
    for (const TileId& tile : tiles)
        for (const ImageryPart& part : terrain::imageryParts(index_, view, texelPixels, tile,
                                                             [](const TextureId&) { return true; }))
            if (part.texture &&
                known.insert(index_.imagery->pyramid.tileIndex(*part.texture)).second)
                textures.push_back(*part.texture);
    return textures;
}

std::vector<TerrainItem> TileImagery::itemsOf(std::span<const TileId> tiles,
                                              const lod::ObjectView& view,
                                              double texelPixels) const {
    std::vector<TerrainItem> items;
    std::unordered_set<std::uint32_t> known;
    for (TextureId texture : texturesOf(tiles, view, texelPixels))
        for (; texture != index_.imagery->pyramid.top();
             texture = TexturePyramid::parent(texture)) {
            const TerrainItem item = paging_.items().of(texture);
            if (!known.insert(item.key).second)
                break;
            items.push_back(item);
        }
    return items;
}

void TileImagery::choose(std::span<const terrain::TileChoice> choices,
                         std::span<const Piece> pieces, const lod::ObjectView& view,
                         double texelPixels, terrain::Unseen unseen) {
    parts_.clear();
    if (!index_.imagery)
        return;
    for (const Piece& piece : pieces) {
        const TileId& tile = choices[piece.index].id;
        parts_.emplace(
            index_.quadtree.tileIndex(tile),
            terrain::imageryParts(
                index_, view, texelPixels, tile,
                [&](const TextureId& texture) { return paging_.isResident(texture); }, unseen));
    }
}

void TileImagery::use(const effects::TerrainEffect& program, const TileId& tile,
                      const ImageryPart& part) const {
    program.partFirst({part.firstX, part.firstY});
    program.partEnd({part.endX, part.endY});
    if (!part.texture) {
        program.picture(hole_.texture());
        return;
    }
    const TexturePyramid& pyramid = index_.imagery->pyramid;
    const double texels = 1 / pyramid.texelPosts(part.texture->level);
    const double side = Quadtree::side(tile.level);
    const auto first = [&](std::int32_t ofTile, std::int32_t ofTexture) {
        return static_cast<float>(ofTile * side * texels -
                                  double{terrain::kTextureSide} * ofTexture +
                                  terrain::kTextureBorder);
    };
    program.pictureFromTile({static_cast<float>(texels), first(tile.x, part.texture->x),
                             first(tile.y, part.texture->y)});
    program.picture(paging_.texture(*part.texture)->texture());
}

}  // namespace eyrie::draw
