// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/terrain_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "renderer/lod/vertical_error.h"

namespace eyrie::terrain {
namespace {

struct Limits {
    double pixels;
    double metres;  ///< of heights, where colours tell
};

/// The error of one tile as one view sees it.
class TileError {
public:
    TileError(const EytIndex& index, const lod::ObjectView& view, const TileId& tile,
              const DrawnGround& ground = kNothingKnown)
        : index_(index), view_(view), tile_(tile), record_(index.tile(tile)), ground_(ground) {}

    /// By the box of the whole tile: quick.
    double atMost() const { return over(tile_); }

    /// Whether a part is beyond either.
    bool exceeds(const Limits& limits) const { return exceeds(tile_, levelsDown(), limits); }

    /// The greatest over the parts; or anything up to `enough` when it is no more than that.
    double pixels(double enough) const {
        return std::max(enough, worstOver(tile_, atMost(), levelsDown(), enough));
    }

    /// The same of the parts where an outline may be off, and no others.
    double ofOutlines() const { return outlinesOver(tile_, levelsDown()); }

private:
    static inline const DrawnGround kNothingKnown;
    static constexpr int kLevelsDown = 2;
    static_assert(1 << kLevelsDown == kTilePartsPerSide);

    int levelsDown() const { return std::min(kLevelsDown, tile_.level); }

    /// `part` as a square of the tile's parts.
    struct Square {
        int x, y, count;
    };
    Square squareOf(const TileId& part) const {
        const int down = tile_.level - part.level;
        const int count = kTilePartsPerSide >> down;
        return {(part.x - (tile_.x << down)) * count, (part.y - (tile_.y << down)) * count, count};
    }
    double errorMetres(const TileId& part) const {
        const auto [x, y, count] = squareOf(part);
        return record_.errorMetresOf(x, y, count);
    }
    bool blursOutline(const TileId& part) const {
        const auto [x, y, count] = squareOf(part);
        return record_.blursOutlineIn(x, y, count);
    }

    /// Of the source in a part, and of what is drawn there but for its error.
    fabric::Box boundsOf(const TileId& part) const {
        fabric::Box bounds = index_.bounds(part);
        if (blursOutline(part)) {
            // What is drawn over a hole is as high as corners that may lie in any part.
            bounds.min.z = record_.minHeightMetres;
            bounds.max.z = record_.maxHeightMetres;
        }
        return bounds;
    }

    double over(const TileId& part) const {
        const fabric::Box bounds = boundsOf(part);
        const double ofSource =
            blursOutline(part) ? view_.screenSpaceErrorPixels(record_.greatestErrorMetres(), bounds)
                               : lod::VerticalError(view_, errorMetres(part)).pixels(bounds);
        return ofSource + ofRounding(bounds);
    }

    /// Triangles in a part may be as large as the tile.
    double ofRounding(const fabric::Box& part) const {
        return record_.triangles == 0 ? 0 : view_.roundingPixels(index_.bounds(tile_), part);
    }

    double outlinesOver(const TileId& part, int levelsDown) const {
        if (!blursOutline(part))
            return 0;
        if (levelsDown == 0)
            return over(part);
        double worst = 0;
        forEachChild(part, [&](const TileId& child) {
            worst = std::max(worst, outlinesOver(child, levelsDown - 1));
        });
        return worst;
    }

    /// Of all that is drawn and of the source in a part.
    bool isHidden(const TileId& part, double pixels) const {
        if (!ground_.isHidden)
            return false;
        fabric::Box bounds = boundsOf(part);
        bounds.min.z -= errorMetres(part);
        bounds.max.z += errorMetres(part);
        return ground_.isHidden(bounds, pixels);
    }

    template <typename Visit>
    void forEachChild(const TileId& part, Visit visit) const {
        for (int i = 0; i < 4; ++i)
            if (const TileId child = Quadtree::child(part, i); index_.quadtree.contains(child))
                visit(child);
    }

    bool exceeds(const TileId& part, int levelsDown, const Limits& limits) const {
        const bool isFar = over(part) > limits.pixels;
        if (!isFar && errorMetres(part) <= limits.metres)
            return false;
        if (levelsDown == 0)
            return isFar || showsHeights(part, limits);
        bool any = false;
        forEachChild(part, [&](const TileId& child) {
            any = any || exceeds(child, levelsDown - 1, limits);
        });
        return any;
    }

    /// Whether colours may tell heights of a part that are `limits.metres` apart: neither do the
    /// tile's posts lie within `limits.pixels` of each other, nor, on the whole, such heights. The
    /// finest level has every post, however little they matter: colours alone do not ask for it.
    bool showsHeights(const TileId& part, const Limits& limits) const {
        const fabric::Box bounds = boundsOf(part);
        const auto& lattice = index_.objectFromLattice;
        const double post = std::max(glm::length(lattice[0]), glm::length(lattice[1]));
        const double partMetres = std::max(bounds.size().x, bounds.size().y);
        const double heights = bounds.size().z / limits.metres;
        return tile_.level > 1 && view_.isVisible(bounds) &&
               view_.screenSpaceErrorPixels(std::ldexp(post, tile_.level), bounds) >
                   limits.pixels &&
               view_.screenSpaceErrorPixels(partMetres, bounds) > heights * limits.pixels;
    }

    /// `own` is over(part).
    double worstOver(const TileId& part, double own, int levelsDown, double enough) const {
        if (own <= enough)
            return own;
        if (isHidden(part, own))
            return enough;
        if (levelsDown == 0)
            return own;
        double worst = enough;
        forEachChild(part, [&](const TileId& child) {
            worst = std::max(worst,
                             worstOver(child, std::min(own, over(child)), levelsDown - 1, worst));
        });
        return worst;
    }

    const EytIndex& index_;
    const lod::ObjectView& view_;
    const TileId tile_;
    const TileRecord& record_;
    const DrawnGround& ground_;
};

void refine(const EytIndex& index, const lod::ObjectView& view, const Limits& limits,
            const TileId& tile, Refinement& refinement) {
    if (tile.level == 0 || !view.isVisible(index.bounds(tile)) ||
        !TileError(index, view, tile).exceeds(limits))
        return;
    refinement.split(tile);
    refinement.forEachChild(
        tile, [&](const TileId& child) { refine(index, view, limits, child, refinement); });
}

std::uint8_t finerEdges(const Refinement& refinement, const TileId& tile) {
    int edges = 0;
    for (int edge = 0; edge < kEdges; ++edge)
        if (const TileId next = Quadtree::neighbour(tile, edge);
            refinement.quadtree().contains(next) && refinement.isSplit(next))
            edges |= 1 << edge;
    return static_cast<std::uint8_t>(edges);
}

}  // namespace

double screenSpaceErrorPixels(const EytIndex& index, const lod::ObjectView& view,
                              const TileId& tile) {
    return TileError(index, view, tile).pixels(0);
}

double outlineErrorPixels(const EytIndex& index, const lod::ObjectView& view, const TileId& tile) {
    return TileError(index, view, tile).ofOutlines();
}

double heightToleranceMetres(const EytIndex& index) {
    constexpr double kReliefShare = 1.0 / 8;
    constexpr double kLeastSteps = 2;  // what is stored is off by half a one
    return index.imagery ? std::numeric_limits<double>::infinity()
                         : std::max(kReliefShare * index.bounds().size().z,
                                    kLeastSteps * index.heightStepMetres());
}

Refinement refineForError(const EytIndex& index, const lod::ObjectView& view, double tauPixels) {
    Refinement refinement(index.quadtree);
    refine(index, view, {tauPixels, tauPixels * heightToleranceMetres(index)}, index.quadtree.top(),
           refinement);
    refinement.restrict();
    return refinement;
}

/// Worst first by their quick bound, so that few tiles are looked at more closely.
double screenSpaceErrorPixels(const EytIndex& index, const lod::ObjectView& view,
                              const TerrainCut& cut, const DrawnGround& ground) {
    std::vector<std::pair<double, const TileChoice*>> order;
    for (const auto* tiles : {&cut.tiles, &cut.holes})
        for (const TileChoice& choice : *tiles)
            if (choice.isVisible)
                order.emplace_back(TileError(index, view, choice.id).atMost(), &choice);
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    double worst = 0;
    for (const auto& [atMost, choice] : order) {
        if (atMost <= worst)
            break;
        double pixels = TileError(index, view, choice->id, ground).pixels(worst);
        if (ground.narrower && pixels > worst)
            pixels = ground.narrower(*choice, pixels, worst);
        worst = std::max(worst, pixels);
    }
    return worst;
}

TerrainCut cutOf(const EytIndex& index, const lod::ObjectView& view, const Refinement& refinement) {
    TerrainCut cut;
    refinement.forEachLeaf([&](const TileId& tile) {
        const bool isVisible = view.isVisible(index.bounds(tile));
        if (index.tile(tile).triangles > 0)
            cut.tiles.push_back({tile, finerEdges(refinement, tile), isVisible});
        else if (isVisible)
            cut.holes.push_back({tile, 0, true});
    });
    return cut;
}

TerrainCut selectCut(const EytIndex& index, const lod::ObjectView& view, double tauPixels) {
    return cutOf(index, view, refineForError(index, view, tauPixels));
}

}  // namespace eyrie::terrain
