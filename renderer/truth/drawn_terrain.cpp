// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/drawn_terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/status.h"
#include "renderer/terrain/terrain_cut.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::truth {
namespace {

using fabric::Vec2;
using fabric::Vec3;
using terrain::Quadtree;

Vec3 corner(const terrain::EytIndex& index, const fabric::Mat4& worldFromPosts,
            const terrain::TileId& id, const terrain::TileGeometry& tile, std::uint16_t number) {
    const terrain::TileVertex vertex = terrain::unpackVertex(
        tile.words, tile.wordsPerVertex, number, tile.baseHeight, tile.heightMultiplier);
    const auto post = [&](std::int32_t first, std::int32_t halves, std::int32_t posts) {
        return std::min(
            first * Quadtree::side(id.level) + (halves << Quadtree::spacingShift(id.level)) / 2,
            posts - 1);
    };
    return Vec3(worldFromPosts * fabric::Vec4(post(id.x, vertex.x, index.quadtree.columns()),
                                              post(id.y, vertex.y, index.quadtree.rows()), vertex.q,
                                              1));
}

/// Visits the points of a triangle whose columns are posts or halfway between them; of a triangle
/// wider than `mostPosts` every second of them, and so on.
template <typename Visit>
void forEachHalfPost(const Triangle& triangle, const fabric::Mat4& postsFromObject,
                     double mostPosts, Visit visit) {
    constexpr double kOnEdge = 1e-6;
    std::array<Vec2, 3> posts;
    for (std::size_t k = 0; k < 3; ++k)
        posts[k] = Vec2(postsFromObject * fabric::Vec4(triangle[k], 1));
    const Vec2 b = posts[1] - posts[0];
    const Vec2 c = posts[2] - posts[0];
    const double area = b.x * c.y - b.y * c.x;
    if (area == 0)
        return;
    const Vec2 low = glm::min(posts[0], glm::min(posts[1], posts[2]));
    const Vec2 high = glm::max(posts[0], glm::max(posts[1], posts[2]));
    double step = 0.5;
    while (std::max(high.x - low.x, high.y - low.y) > 2 * mostPosts * step) step *= 2;
    for (double y = std::ceil(low.y / step - kOnEdge) * step; y <= high.y + kOnEdge; y += step)
        for (double x = std::ceil(low.x / step - kOnEdge) * step; x <= high.x + kOnEdge;
             x += step) {
            const Vec2 p = Vec2(x, y) - posts[0];
            const double toB = (p.x * c.y - p.y * c.x) / area;
            const double toC = (b.x * p.y - b.y * p.x) / area;
            if (toB >= -kOnEdge && toC >= -kOnEdge && toB + toC <= 1 + kOnEdge)
                visit(triangle[0] + toB * (triangle[1] - triangle[0]) +
                      toC * (triangle[2] - triangle[0]));
        }
}

}  // namespace

absl::StatusOr<DrawnTerrain> DrawnTerrain::of(const terrain::EytFile& file, const lod::View& view,
                                              double tauPixels,
                                              const fabric::Mat4& worldFromObject) {
    const terrain::EytIndex& index = file.index();
    const lod::ObjectView objectView(view, worldFromObject);
    const fabric::Mat4 worldFromPosts = worldFromObject * index.objectFromLattice;
    DrawnTerrain drawn;
    drawn.postsFromWorld_ = glm::inverse(worldFromPosts);
    for (const terrain::TileChoice& choice :
         terrain::selectCut(index, objectView, tauPixels).tiles) {
        if (!choice.isVisible)
            continue;
        ASSIGN_OR_RETURN(const auto page, file.readPage(index.quadtree.pageIndex(choice.id)));
        const terrain::TileGeometry& tile = page->tile(Quadtree::placeInPage(choice.id));
        for (int part = 0; part < terrain::kTileParts; ++part) {
            const int edge = (part - 1) % terrain::kEdges;
            const bool isFiner = part >= terrain::kFinerPart;
            if (part > 0 && isFiner != ((choice.finerEdges >> edge & 1) != 0))
                continue;
            const terrain::IndexRange& range = tile.parts[static_cast<std::size_t>(part)];
            for (std::uint32_t k = range.first; k < range.first + range.count; k += 3)
                drawn.triangles_.push_back(
                    {corner(index, worldFromPosts, choice.id, tile, tile.indices[k]),
                     corner(index, worldFromPosts, choice.id, tile, tile.indices[k + 1]),
                     corner(index, worldFromPosts, choice.id, tile, tile.indices[k + 2])});
        }
    }
    return drawn;
}

double DrawnTerrain::farthestSeen(const Pinhole& camera, const TerrainRayCaster& source,
                                  double atLeast) const {
    struct Candidate {
        double pixels;
        Vec3 source;
    };
    constexpr double kMostPosts = 256;
    std::vector<Candidate> candidates;
    for (const Triangle& triangle : triangles_)
        forEachHalfPost(triangle, postsFromWorld_, kMostPosts, [&](const Vec3& drawn) {
            const auto other = source.counterpart(drawn);
            const auto p = camera.project(drawn);
            const auto q = other ? camera.project(*other) : std::nullopt;
            if (!p || !q || q->x < 0 || q->y < 0 || q->x > camera.width() || q->y > camera.height())
                return;
            if (const double pixels = camera.pixelsBetween(*p, *q); pixels > atLeast)
                candidates.push_back({pixels, *other});
        });
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.pixels > b.pixels; });
    constexpr double kSamePoint = 1e-9;
    const auto seen = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& c) {
        const auto at = camera.project(c.source);
        return source.hitRange(camera.rayThrough(at->x, at->y)).first >=
               camera.depth(c.source) * (1 - kSamePoint);
    });
    return seen == candidates.end() ? atLeast : seen->pixels;
}

std::vector<float> DrawnTerrain::heightsAtHalfPosts(int width, int height) const {
    const auto columns = static_cast<std::size_t>(width);
    std::vector<float> heights(columns * static_cast<std::size_t>(height),
                               std::numeric_limits<float>::quiet_NaN());
    for (const Triangle& triangle : triangles_)
        forEachHalfPost(triangle, postsFromWorld_, width + height, [&](const Vec3& point) {
            const Vec2 halves = 2.0 * Vec2(postsFromWorld_ * fabric::Vec4(point, 1));
            heights[static_cast<std::size_t>(std::lround(halves.y)) * columns +
                    static_cast<std::size_t>(std::lround(halves.x))] = static_cast<float>(point.z);
        });
    return heights;
}

}  // namespace eyrie::truth
