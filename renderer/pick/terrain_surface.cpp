// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/terrain_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/frustum.h"
#include "fabric/look.h"
#include "fabric/status.h"
#include "renderer/pick/column_walk.h"
#include "renderer/pick/drawn_posts.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::pick {
namespace {

using fabric::Vec3;
using terrain::TileId;

constexpr std::int32_t kCells = terrain::kFinestTileCells;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// A ray in lattice space: columns, rows and steps of height.
struct LatticeRay {
    /// `last`: the posts' last column and row.
    LatticeRay(const Ray& world, const fabric::Mat4& worldFromLattice, const fabric::Vec2& last)
        : ray(inFrame(world, worldFromLattice)) {
        const fabric::Mat3 inverse = glm::inverse(fabric::Mat3(worldFromLattice));
        const double metres = glm::length(world.origin) + glm::length(Vec3(worldFromLattice[3]));
        for (int row = 0; row < 3; ++row) {
            const double reach =
                std::abs(inverse[0][row]) + std::abs(inverse[1][row]) + std::abs(inverse[2][row]);
            rounding[row] = 16 * kEpsilon * (reach * metres + std::abs(ray.origin[row]));
        }
        if (std::max(std::abs(ray.direction.x), std::abs(ray.direction.y)) < leastTilt())
            tilt(last);
        along = fabric::Vec2(ray.direction);
        alongSquared = glm::dot(along, along);
    }

    /// Beyond any rounding, and leaves every ray a way along the ground.
    double leastTilt() const { return 1e-20 * std::abs(ray.direction.z); }

    /// Inwards, so that rays on a border have their way over the terrain, too: straight from the
    /// nearest border, as no other way along it starts at 0 however crossings are rounded, and a
    /// trifle aside, for corners. What rounding took out over a border is put back on it.
    void tilt(const fabric::Vec2& last) {
        const fabric::Vec2 inside = glm::clamp(fabric::Vec2(ray.origin), fabric::Vec2(0), last);
        if (std::abs(inside.x - ray.origin.x) <= rounding.x &&
            std::abs(inside.y - ray.origin.y) <= rounding.y)
            ray.origin = Vec3(inside, ray.origin.z);
        const fabric::Vec2 inwards = last / 2.0 - fabric::Vec2(ray.origin);
        const bool isByX = std::abs(inwards.x) * last.y >= std::abs(inwards.y) * last.x;
        ray.direction.x = std::copysign(leastTilt() * (isByX ? 1 : 1e-20), inwards.x);
        ray.direction.y = std::copysign(leastTilt() * (isByX ? 1e-20 : 1), inwards.y);
    }

    /// Positive for points to one side of the ray seen from above. Of a point it is the same in
    /// whichever triangle.
    double side(const terrain::TileVertex& v) const {
        return along.x * (v.y - ray.origin.y) - along.y * (v.x - ray.origin.x);
    }

    Ray ray;
    fabric::Vec2 along{0, 0};
    double alongSquared = 0;
    Vec3 rounding{0, 0, 0};  ///< of a place, in the lattice's units
};

/// A place where a side of a triangle passes under or over the ray.
struct Crossing {
    double t;
    double above;
};

/// `a` on the ray's positive side, `b` on the other: triangles on either side compute the same.
Crossing crossing(const LatticeRay& lattice, const terrain::TileVertex& a, double sideA,
                  const terrain::TileVertex& b, double sideB) {
    const double share = sideA / (sideA - sideB);
    const double x = a.x + share * (b.x - a.x) - lattice.ray.origin.x;
    const double y = a.y + share * (b.y - a.y) - lattice.ray.origin.y;
    const double t = (x * lattice.along.x + y * lattice.along.y) / lattice.alongSquared;
    return {t, lattice.ray.origin.z + t * lattice.ray.direction.z - (a.q + share * (b.q - a.q))};
}

/// What is drawn of one tile, seen along a ray. Keeps scratch memory from tile to tile.
class TileColumns {
public:
    struct Place {
        Column column;
        Vec3 normal;         ///< lattice
        Vec3 corner;         ///< lattice
        double heightError;  ///< steps, of the triangle's height below the ray
    };

    /// In the order in which the ray passes them. `error`: the tile's, in steps.
    const std::vector<Place>& along(const LatticeRay& lattice, const terrain::TileGeometry& tile,
                                    const TileId& id, const terrain::Quadtree& quadtree,
                                    double error) {
        places_.clear();
        passed_.clear();
        readVertices(lattice, tile, id, quadtree);
        for (std::size_t k = 0; k < tile.parts[terrain::kFinerPart].first; k += 3)
            addTriangle(lattice, {tile.indices[k], tile.indices[k + 1], tile.indices[k + 2]});
        for (const Passed& one : passed_) addColumn(lattice, one, error);
        std::ranges::sort(places_, {}, [](const Place& one) { return one.column.span.begin; });
        return places_;
    }

private:
    using Indices = std::array<std::uint16_t, 3>;

    struct Passed {
        Indices corners;
        std::array<Crossing, 2> ends;
    };

    void readVertices(const LatticeRay& lattice, const terrain::TileGeometry& tile,
                      const TileId& id, const terrain::Quadtree& quadtree) {
        vertices_.clear();
        sides_.clear();
        posts_.begin(id.x * kCells, id.y * kCells);
        for (std::size_t n = 0; n < tile.vertexCount(); ++n) {
            terrain::TileVertex v = terrain::unpackVertex(tile.words, tile.wordsPerVertex, n,
                                                          tile.baseHeight, tile.heightMultiplier);
            v.x = std::min(id.x * kCells + (v.x >> 1), quadtree.columns() - 1);
            v.y = std::min(id.y * kCells + (v.y >> 1), quadtree.rows() - 1);
            vertices_.push_back(v);
            sides_.push_back(lattice.side(v));
        }
    }

    void addTriangle(const LatticeRay& lattice, const Indices& corners) {
        posts_.cover(vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]]);
        // A point on the ray counts to its positive side, in all triangles.
        const std::array<bool, 3> isLeft = {sides_[corners[0]] >= 0, sides_[corners[1]] >= 0,
                                            sides_[corners[2]] >= 0};
        if (isLeft[0] == isLeft[1] && isLeft[1] == isLeft[2])
            return;
        std::array<Crossing, 2> ends{};
        std::size_t count = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint16_t a = corners[k];
            std::uint16_t b = corners[(k + 1) % 3];
            if (isLeft[k] == isLeft[(k + 1) % 3])
                continue;
            if (!isLeft[k])
                std::swap(a, b);
            ends[count++] = crossing(lattice, vertices_[a], sides_[a], vertices_[b], sides_[b]);
        }
        if (ends[0].t > ends[1].t)
            std::swap(ends[0], ends[1]);
        if (ends[1].t >= fabric::kNearMetres)
            passed_.push_back({corners, ends});
    }

    void addColumn(const LatticeRay& lattice, const Passed& passed, double error) {
        const auto& [a, b, c] = std::tie(vertices_[passed.corners[0]], vertices_[passed.corners[1]],
                                         vertices_[passed.corners[2]]);
        const Vec3 corner(a.x, a.y, a.q);
        const Vec3 normal = glm::cross(Vec3(b.x, b.y, b.q) - corner, Vec3(c.x, c.y, c.q) - corner);
        if (normal.z == 0)
            return;
        const auto& [comes, goes] = passed.ends;
        Column column{{comes.t, goes.t}, comes.above, goes.above};
        column.above0 = glm::dot(normal, lattice.ray.origin - corner) / normal.z;
        column.rise = glm::dot(normal, lattice.ray.direction) / normal.z;
        if (column.span.begin < fabric::kNearMetres) {
            column.span.begin = fabric::kNearMetres;
            column.comes = column.above0 + column.rise * column.span.begin;
        }
        const double slope = (std::abs(normal.x) + std::abs(normal.y)) / std::abs(normal.z);
        const double heightError = error + posts_.twist(a, b, c) +
                                   slope * std::max(lattice.rounding.x, lattice.rounding.y);
        column.error = heightError + lattice.rounding.z;
        places_.push_back({column, normal, corner, heightError});
    }

    std::vector<terrain::TileVertex> vertices_;  ///< posts
    std::vector<double> sides_;
    std::vector<Passed> passed_;
    std::vector<Place> places_;
    DrawnPosts posts_;
};

/// One ray's way over a terrain.
class Walk {
public:
    Walk(const terrain::EytFile& file, const fabric::Mat4& worldFromLattice, const Ray& ray,
         const CastOptions& options)
        : file_(file),
          index_(file.index()),
          worldFromLattice_(worldFromLattice),
          lattice_(ray, worldFromLattice,
                   {index_.quadtree.columns() - 1, index_.quadtree.rows() - 1}),
          options_(options) {}

    absl::StatusOr<Cast> go() {
        if (!spanIn(index_.quadtree.top()).isEmpty())
            RETURN_IF_ERROR(visit(index_.quadtree.top()));
        return Cast{hit_, columns_.nearest(), columns_.farthest()};
    }

private:
    /// Of the ray, in the tile's box; everything that may be met lies in there. Once something may
    /// have been, also above and below it, where the ray is beyond what it met for certain.
    Span spanIn(const TileId& id) const {
        const std::int32_t side = terrain::Quadtree::side(id.level);
        const terrain::TileRecord& record = index_.tile(id);
        const auto steps = [&](double metres) {
            return (metres - index_.heightOriginMetres()) / index_.heightStepMetres();
        };
        fabric::Box box;
        box.grow({id.x * side, id.y * side, steps(record.minHeightMetres)});
        box.grow({std::min(id.x * side + side, index_.quadtree.columns() - 1),
                  std::min(id.y * side + side, index_.quadtree.rows() - 1),
                  steps(record.maxHeightMetres)});
        const double relief = columns_.nearest() < kNowhere ? box.size().z : 0;
        const Vec3 beyond = lattice_.rounding + Vec3(1e-9, 1e-9, 1 + errorSteps(id) + relief);
        return clip({fabric::kNearMetres, std::min(options_.farthest, columns_.farthest())},
                    lattice_.ray, {box.min - beyond, box.max + beyond});
    }

    double errorSteps(const TileId& id) const {
        return static_cast<double>(index_.tile(id).errorMetres) / index_.heightStepMetres();
    }

    absl::Status visit(const TileId& id) {
        if (id.level == 0)
            return index_.tile(id).triangles == 0 ? absl::OkStatus() : visitTile(id);
        // In the order in which the ray passes them.
        const int nearest = (lattice_.along.x < 0 ? 1 : 0) | (lattice_.along.y < 0 ? 2 : 0);
        for (int i = 0; i < 4; ++i)
            if (const TileId child = terrain::Quadtree::child(id, i ^ nearest);
                index_.quadtree.contains(child) && !spanIn(child).isEmpty())
                RETURN_IF_ERROR(visit(child));
        return absl::OkStatus();
    }

    absl::Status visitTile(const TileId& id) {
        RETURN_IF_ERROR(checkDeadline(options_));
        ASSIGN_OR_RETURN(const auto page, readPage(index_.quadtree.pageIndex(id)));
        const terrain::TileGeometry& tile = page->tile(terrain::Quadtree::placeInPage(id));
        for (const TileColumns::Place& place :
             tileColumns_.along(lattice_, tile, id, index_.quadtree, errorSteps(id)))
            if (columns_.pass(place.column))
                hit_ = hitOf(place);
        return absl::OkStatus();
    }

    Hit hitOf(const TileColumns::Place& place) const {
        const double t = columns_.hit();
        const fabric::Mat3 linear(worldFromLattice_);
        // The triangle's own height: the ray's loses its digits where heights are drawn flat.
        const Vec3 aside = lattice_.ray.at(t) - place.corner;
        const Vec3& n = place.normal;
        const double q = place.corner.z - (n.x * aside.x + n.y * aside.y) / n.z;
        const double elevation = index_.heightOriginMetres() + q * index_.heightStepMetres();
        const double rounding =
            16 * kEpsilon * (std::abs(index_.heightOriginMetres()) + std::abs(elevation));
        return {t, glm::inverse(glm::transpose(linear)) * n,
                place.column.error * glm::length(linear[2]), elevation,
                place.heightError * index_.heightStepMetres() + rounding};
    }

    absl::StatusOr<std::shared_ptr<const terrain::Page>> readPage(std::uint32_t number) {
        const RecentPages::Key key{options_.object, number};
        if (auto page = options_.pages.find(key))
            return std::static_pointer_cast<const terrain::Page>(page);
        ASSIGN_OR_RETURN(auto page, file_.readPage(number));
        options_.pages.keep(key, page, page->sizeBytes());
        return page;
    }

    const terrain::EytFile& file_;
    const terrain::EytIndex& index_;
    const fabric::Mat4 worldFromLattice_;
    const LatticeRay lattice_;
    const CastOptions& options_;
    TileColumns tileColumns_;
    ColumnWalk columns_;
    std::optional<Hit> hit_;
};

class TerrainSurface final : public Surface {
public:
    TerrainSurface(const fabric::SceneObject& object, std::shared_ptr<const terrain::EytFile> file)
        : worldFromObject_(object.worldFromObject), file_(std::move(file)) {}

    absl::StatusOr<Cast> cast(const Ray& ray, const CastOptions& options) const override {
        return Walk(*file_,
                    fabric::exaggerated(worldFromObject_, options.exaggeration) *
                        file_->index().objectFromLattice,
                    ray, options)
            .go();
    }

private:
    const fabric::Mat4 worldFromObject_;
    const std::shared_ptr<const terrain::EytFile> file_;
};

}  // namespace

std::unique_ptr<const Surface> terrainSurface(const fabric::SceneObject& object,
                                              std::shared_ptr<const terrain::EytFile> file) {
    return std::make_unique<TerrainSurface>(object, std::move(file));
}

}  // namespace eyrie::pick
