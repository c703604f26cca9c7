// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_items.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::draw {
namespace {

using fabric::Vec3;
using terrain::Quadtree;
using terrain::TextureId;
using terrain::TileId;
using testing::ElementsAreArray;

constexpr std::int32_t kPosts = 513;
constexpr double kPostMetres = 30;
constexpr double kSide = (kPosts - 1) * kPostMetres;
/// Texture tiles of the finest level are as large as tiles of theirs.
constexpr int kTexelShift = 4;

/// A level terrain, 16 tiles of the finest level a side and as many texture tiles: an index without
/// a file.
class TerrainItemsInOrder : public testing::Test {
protected:
    void SetUp() override {
        index_.quadtree = Quadtree(kPosts, kPosts);
        index_.objectFromLattice[0][0] = index_.objectFromLattice[1][1] = kPostMetres;
        index_.tiles.resize(index_.quadtree.tileCount());
        for (terrain::TileRecord& tile : index_.tiles) tile.triangles = 100;
        index_.imagery.emplace();
        index_.imagery->pyramid = terrain::TexturePyramid(kPosts, kPosts, kTexelShift);
    }

    void setError(const TileId& tile, float metres) {
        index_.tiles[index_.quadtree.tileIndex(tile)].errorMetres = metres;
    }
    /// Of what is drawn while the tile is not there.
    void setStandIn(const TileId& tile, float metres) { setError(Quadtree::parent(tile), metres); }

    /// All of the terrain from straight above a place, in shares of its side.
    static lod::ObjectView above(double x, double y) {
        fabric::Camera camera;
        camera.target = Vec3(x * kSide, y * kSide, 0);
        camera.eye = camera.target + Vec3(0, 0, 3 * kSide);
        camera.up = {0, 1, 0};
        return {lod::View(camera, 1000, 1000), fabric::Mat4(1.0)};
    }

    std::vector<std::uint32_t> keysOf(const std::vector<TileId>& tiles) const {
        std::vector<std::uint32_t> keys;
        for (const TileId& tile : tiles) keys.push_back(items_.of(tile).key);
        return keys;
    }

    std::vector<std::uint32_t> inOrder(const std::vector<TileId>& tiles,
                                       const std::vector<TextureId>& textures,
                                       const lod::ObjectView& view) const {
        std::vector<std::uint32_t> keys;
        for (const TerrainItem& item : items_.inOrder(tiles, textures, view))
            keys.push_back(item.key);
        return keys;
    }

    terrain::EytIndex index_;
    TerrainItems items_{index_, TextureFormat::Rgba8};
};

/// Around the middle of the terrain, alike in all but what is drawn instead of them.
const std::vector<TileId> kAround = {{0, 6, 6}, {0, 9, 6}, {0, 6, 9}, {0, 9, 9}};

TEST_F(TerrainItemsInOrder, ThoseComeFirstWhoseStandInsAreFartherOff) {
    const std::vector<float> standIns = {1, 40, 5, 20};
    for (std::size_t k = 0; k < kAround.size(); ++k) {
        setStandIn(kAround[k], standIns[k]);
        setError(kAround[k], 1 / standIns[k]);  // which counts for nothing
    }
    EXPECT_THAT(inOrder(kAround, {}, above(0.5, 0.5)),
                ElementsAreArray(keysOf({kAround[1], kAround[3], kAround[2], kAround[0]})));
}

TEST_F(TerrainItemsInOrder, OfEqualErrorsThoseNearerTheMiddleOfThePictureComeFirst) {
    for (terrain::TileRecord& tile : index_.tiles) tile.errorMetres = 10;
    const std::vector<TileId> diagonal = {{0, 1, 1}, {0, 14, 14}, {0, 5, 5}, {0, 9, 9}};
    EXPECT_THAT(inOrder(diagonal, {}, above(9.5 / 16, 9.5 / 16)),
                ElementsAreArray(keysOf({{0, 9, 9}, {0, 5, 5}, {0, 14, 14}, {0, 1, 1}})));
    EXPECT_THAT(inOrder(diagonal, {}, above(1.5 / 16, 1.5 / 16)),
                ElementsAreArray(keysOf({{0, 1, 1}, {0, 5, 5}, {0, 9, 9}, {0, 14, 14}})));
}

/// A tile that is much farther off outweighs the middle, one that is hardly does not.
TEST_F(TerrainItemsInOrder, ErrorAndPlaceAreWeighed) {
    const TileId middle{0, 8, 8};
    const TileId corner{0, 15, 15};
    setStandIn(middle, 10);
    for (const auto& [metres, expected] :
         {std::pair(11.0F, std::vector{middle, corner}), {1000.0F, std::vector{corner, middle}}}) {
        setStandIn(corner, metres);
        EXPECT_THAT(inOrder({corner, middle}, {}, above(0.5, 0.5)),
                    ElementsAreArray(keysOf(expected)))
            << metres;
    }
}

/// They cover what is missing at all.
TEST_F(TerrainItemsInOrder, LargeOnesComeBeforeSmallOnesWhateverTheirErrors) {
    const TileId small{0, 8, 8};
    const TileId large{2, 0, 0};
    setStandIn(small, 1000);
    setStandIn(large, 0.001F);
    EXPECT_THAT(inOrder({small, large}, {}, above(0.5, 0.5)),
                ElementsAreArray(keysOf({large, small})));
    const TextureId texture = {1, 1, 1};
    EXPECT_THAT(inOrder({small}, {texture}, above(0.5, 0.5)),
                ElementsAreArray({items_.of(texture).key, items_.of(small).key}));
}

/// By the texels of what stands in for them: 2 / 16 posts wide.
TEST_F(TerrainItemsInOrder, TextureTilesStandAmongTilesOfTheirSize) {
    constexpr float kTexelMetres = 2 * kPostMetres / (1 << kTexelShift);
    const TileId west{0, 6, 8};
    const TileId east{0, 9, 8};
    const TextureId between{0, 6, 7};
    setStandIn(west, 2 * kTexelMetres);
    setStandIn(east, kTexelMetres / 2);
    EXPECT_THAT(
        inOrder({east, west}, {between}, above(0.5, 0.5)),
        ElementsAreArray({items_.of(west).key, items_.of(between).key, items_.of(east).key}));
}

}  // namespace
}  // namespace eyrie::draw
