// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/imagery_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::terrain {
namespace {

/// Level ground of 10 m posts, pictures of 2^shift texels a post all over it.
EytIndex ground(int texelShift) {
    EytIndex index;
    index.quadtree = Quadtree(1100, 700);
    index.objectFromLattice[0][0] = 10;
    index.objectFromLattice[1][1] = 10;
    index.tiles.assign(index.quadtree.tileCount(), {0, 0, 50, 2});
    index.imagery.emplace();
    index.imagery->pyramid = TexturePyramid(1100, 700, texelShift);
    index.imagery->tiles.assign(index.imagery->pyramid.tileCount(), {0, 1, 0});
    return index;
}

lod::ObjectView viewFrom(const fabric::Vec3& eye, const fabric::Vec3& target) {
    fabric::Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.up = {0, 1, 0};
    return {lod::View(camera, 1280, 720), fabric::Mat4(1.0)};
}

lod::ObjectView someView() {
    const fabric::Vec3 target(*rc::gen::inRange(0, 11000), *rc::gen::inRange(0, 7000), 20);
    const fabric::Vec3 away(*rc::gen::inRange(-3000, 3000), *rc::gen::inRange(-3000, 3000),
                            *rc::gen::inRange(60, 20000));
    return viewFrom(target + away, target);
}

TileId someTile(const EytIndex& index) {
    return index.quadtree.tileOf(*rc::gen::inRange(0U, index.quadtree.tileCount()));
}

bool isThere(const TextureId&) { return true; }

bool holds(const ImageryPart& part, double x, double y) {
    return x >= part.firstX && x < part.endX && y >= part.firstY && y < part.endY;
}

/// Whether the texture tile covers a post of the grid.
bool covers(const TexturePyramid& pyramid, const TextureId& texture, double x, double y) {
    const double side = pyramid.sidePosts(texture.level);
    return x >= side * texture.x && x <= side * (texture.x + 1) && y >= side * texture.y &&
           y <= side * (texture.y + 1);
}

RC_GTEST_PROP(ImageryParts, CoverWhatIsSeenOfATileOnceWithTexturesThatLieThere, ()) {
    const EytIndex index = ground(*rc::gen::inRange(-6, 7));
    const lod::ObjectView view = someView();
    const TileId tile = someTile(index);
    const auto parts = imageryParts(index, view, kTexelPixels, tile, isThere);
    const int side = Quadtree::side(tile.level);
    for (int k = 0; k < 20; ++k) {
        const double x = *rc::gen::inRange(0, 1000) * 1e-3 * side;
        const double y = *rc::gen::inRange(0, 1000) * 1e-3 * side;
        const double gridX = tile.x * side + x;
        const double gridY = tile.y * side + y;
        if (gridX > index.quadtree.columns() - 1 || gridY > index.quadtree.rows() - 1)
            continue;
        fabric::Box point;
        point.grow({10 * gridX, 10 * gridY, 25});
        if (!view.isVisible(point))
            continue;
        const auto count = std::count_if(parts.begin(), parts.end(),
                                         [&](const auto& part) { return holds(part, x, y); });
        RC_ASSERT(count == 1);
        for (const ImageryPart& part : parts)
            if (holds(part, x, y))
                RC_ASSERT(part.texture.has_value() &&
                          covers(index.imagery->pyramid, *part.texture, gridX, gridY));
    }
}

RC_GTEST_PROP(ImageryParts, HaveTexelsNoLargerOnTheScreenThanAskedForUnlessTheyAreTheFinest, ()) {
    const EytIndex index = ground(*rc::gen::inRange(-6, 7));
    const lod::ObjectView view = someView();
    const TileId tile = someTile(index);
    if (!view.isVisible(index.bounds(tile)))
        return;
    const double asked = *rc::gen::element(0.5, kTexelPixels, 8.0);
    const auto parts = imageryParts(index, view, asked, tile, isThere);
    const bool isWhole = parts.size() == 1;
    for (const ImageryPart& part : parts) {
        if (!part.texture || part.texture->level == 0 || !isWhole)
            continue;
        const double texel = 10 * index.imagery->pyramid.texelPosts(part.texture->level);
        RC_ASSERT(view.screenSpaceErrorPixels(texel, index.bounds(tile)) <= asked);
    }
}

RC_GTEST_PROP(ImageryParts, HaveAnAncestorInPlaceOfWhatIsNotThere, ()) {
    const EytIndex index = ground(*rc::gen::inRange(-3, 5));
    const lod::ObjectView view = someView();
    const TileId tile = someTile(index);
    const int coarse = *rc::gen::inRange(0, index.imagery->pyramid.levels());
    const auto isCoarse = [&](const TextureId& texture) { return texture.level >= coarse; };
    for (const ImageryPart& part : imageryParts(index, view, kTexelPixels, tile, isCoarse))
        RC_ASSERT(part.texture.has_value() && part.texture->level >= coarse);
}

/// As what another view sees of it may be any of it.
RC_GTEST_PROP(ImageryParts, CoverAllOfATileWhereNoneIsLeftOut, ()) {
    const EytIndex index = ground(*rc::gen::inRange(-6, 7));
    const TileId tile = someTile(index);
    const auto parts =
        imageryParts(index, someView(), kTexelPixels, tile, isThere, Unseen::Coarsest);
    const int side = Quadtree::side(tile.level);
    for (int k = 0; k < 20; ++k) {
        const double x = *rc::gen::inRange(0, 1000) * 1e-3 * side;
        const double y = *rc::gen::inRange(0, 1000) * 1e-3 * side;
        if (tile.x * side + x > index.quadtree.columns() - 1 ||
            tile.y * side + y > index.quadtree.rows() - 1)
            continue;
        RC_ASSERT(std::ranges::count_if(parts, [&](const ImageryPart& part) {
                      return holds(part, x, y) && part.texture.has_value();
                  }) == 1);
    }
}

TEST(ImageryParts, AreOneWhereOneTextureTileCoversTheTile) {
    const EytIndex index = ground(2);  // 128 posts a texture tile
    const auto parts = imageryParts(index, viewFrom({1000, 1000, 300}, {1000, 1000, 0}),
                                    kTexelPixels, {0, 3, 3}, isThere);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].texture, (TextureId{0, 0, 0}));
    EXPECT_EQ(parts[0].firstX, -ImageryPart::kEndless);
    EXPECT_EQ(parts[0].endY, ImageryPart::kEndless);
}

TEST(ImageryParts, AreManyOnPicturesMuchFinerThanThePosts) {
    const EytIndex index = ground(6);  // 8 posts a texture tile, 32 a tile
    const auto parts = imageryParts(index, viewFrom({160, 160, 120}, {160, 160, 0}), kTexelPixels,
                                    {0, 0, 0}, isThere);
    EXPECT_GT(parts.size(), 3U);
}

/// Memory is so short that any texels will do, and around the eye no size on the screen is finite.
TEST(ImageryParts, AreTheTopTextureWhereAnyTexelsWillDo) {
    const EytIndex index = ground(2);
    const auto parts =
        imageryParts(index, viewFrom({1000, 1000, 25}, {2000, 1000, 25}),
                     std::numeric_limits<double>::infinity(), index.quadtree.top(), isThere);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_TRUE(parts[0].isWhole());
    EXPECT_EQ(parts[0].texture, index.imagery->pyramid.top());
}

TEST(ImageryParts, HaveNoTextureWhereThereIsNoPicture) {
    EytIndex index = ground(0);
    index.imagery->tiles.assign(index.imagery->pyramid.tileCount(), {});
    for (const ImageryPart& part : imageryParts(index, viewFrom({500, 500, 900}, {500, 500, 0}),
                                                kTexelPixels, {0, 0, 0}, isThere))
        EXPECT_FALSE(part.texture.has_value());
}

}  // namespace
}  // namespace eyrie::terrain
