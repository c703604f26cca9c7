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

/// Weights of the point of a plane triangle that is nearest to `point`.
Vec3 nearestWeights(const std::array<Vec2, 3>& corners, const Vec2& point) {
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; };
    const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const Vec3 inside = Vec3(cross(corners[1] - point, corners[2] - point),
                             cross(corners[2] - point, corners[0] - point),
                             cross(corners[0] - point, corners[1] - point)) /
                        area;
    if (area != 0 && inside.x >= 0 && inside.y >= 0 && inside.z >= 0)
        return inside;
    Vec3 best(0);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vec2 a = corners[static_cast<std::size_t>(k)];
        const Vec2 side = corners[static_cast<std::size_t>((k + 1) % 3)] - a;
        const double length = glm::dot(side, side);
        const double t =
            length > 0 ? std::clamp(glm::dot(point - a, side) / length, 0.0, 1.0) : 0.0;
        if (const double distance = glm::distance(point, a + t * side); distance < least) {
            least = distance;
            best = Vec3(0);
            best[k] = 1 - t;
            best[(k + 1) % 3] = t;
        }
    }
    return best;
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

std::optional<DrawnTerrain::Shown> DrawnTerrain::shownAt(const Pinhole& camera, double x, double y,
                                                         double depth, double reachPixels) const {
    std::optional<Shown> best;
    const Ray ray = camera.rayThrough(x, y);
    for (const Triangle& triangle : triangles_) {
        std::array<Vec2, 3> projected;
        bool isBefore = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto p = camera.project(triangle[k]);
            isBefore = isBefore && p;
            projected[k] = p.value_or(Vec2(0));
        }
        if (!isBefore)
            continue;  // reaches behind the eye: never edge-on and far away
        const Vec3 weights = nearestWeights(projected, {x, y});
        const Vec2 nearest =
            weights.x * projected[0] + weights.y * projected[1] + weights.z * projected[2];
        const double aside = glm::distance(nearest, {x, y});
        if (!(aside <= reachPixels))
            continue;
        const Vec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        const double atCentre =
            glm::dot(normal, triangle[0] - ray.origin) / glm::dot(normal, ray.direction);
        if (best && !(std::abs(atCentre - depth) < std::abs(best->depthAtPoint - depth)))
            continue;
        // Weights on the screen to weights in space.
        Vec3 inSpace;
        for (int k = 0; k < 3; ++k)
            inSpace[k] = weights[k] / camera.depth(triangle[static_cast<std::size_t>(k)]);
        inSpace /= inSpace.x + inSpace.y + inSpace.z;
        best = {inSpace.x * triangle[0] + inSpace.y * triangle[1] + inSpace.z * triangle[2],
                atCentre};
    }
    return best;
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
            if (const double pixels = glm::distance(*p, *q); pixels > atLeast)
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
