// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "renderer/lod/view.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/refinement.h"

namespace eyrie::terrain {

/// A tile of a cut and how it is drawn.
struct TileChoice {
    TileId id;
    /// Bit `edge` is set where the neighbour beyond that edge is drawn one level finer: draw
    /// kFinerPart + edge there, kOwnPart + edge elsewhere.
    std::uint8_t finerEdges = 0;
    bool isVisible = false;  ///< to the view

    bool operator==(const TileChoice&) const = default;
};

/// The tiles that stand for a terrain in one view.
struct TerrainCut {
    /// Covers the terrain once, seen or not, less tiles without triangles. Depth-first order:
    /// a parent's children by ascending Quadtree::child, so a share of it is a compact region.
    std::vector<TileChoice> tiles;
    std::vector<TileChoice> holes;  ///< the visible tiles without triangles: they have an outline
};

/// Screen-space error of a tile, in pixels: a bound as lod::VerticalError's, over the boxes of the
/// tile's parts two levels down, which lie closer to the ground than its own. Of parts where the
/// outline of a hole may be off, to any side, ObjectView::screenSpaceErrorPixels.
double screenSpaceErrorPixels(const EytIndex& index, const lod::ObjectView& view,
                              const TileId& tile);

/// The same of those parts alone where the outline of a hole may be off; 0 where there are none.
double outlineErrorPixels(const EytIndex& index, const lod::ObjectView& view, const TileId& tile);

/// By how much heights may be off that colours go by, at tau 1: an eighth of the relief. Where all
/// relief is lower than a pixel is wide, everything is in its place on a plain, whatever its
/// colour. Infinite under imagery, which has colours of its own.
double heightToleranceMetres(const EytIndex& index);

/// What is known of a cut beyond the index. Either may be empty.
struct DrawnGround {
    /// A bound on the error of a tile that is narrower than `pixels`, where there is one; anything
    /// up to `enough` when it is no more than that.
    std::function<double(const TileChoice& tile, double pixels, double enough)> narrower;
    /// Whether nobody sees what lies in `bounds`, drawn or of the source, in a picture that
    /// promises `pixels`.
    std::function<bool(const fabric::Box& bounds, double pixels)> isHidden;
};

/// The coarsest restricted refinement whose visible tiles keep `tauPixels`, as far as the data go,
/// and, down to level 1, tauPixels times heightToleranceMetres() where colours may tell: not where
/// a tile's posts, or heights that far apart, follow each other within `tauPixels`. Depends on the
/// view alone, so all channels of a frame, on whatever node, choose the same.
Refinement refineForError(const EytIndex& index, const lod::ObjectView& view, double tauPixels);

/// The leaves of a restricted refinement, and how they are drawn.
TerrainCut cutOf(const EytIndex& index, const lod::ObjectView& view, const Refinement& refinement);

/// Screen-space error of all that is seen of a cut, in pixels: a bound. `ground` is asked of the
/// tiles that would decide it, worst first.
double screenSpaceErrorPixels(const EytIndex& index, const lod::ObjectView& view,
                              const TerrainCut& cut, const DrawnGround& ground = {});

/// cutOf(refineForError()).
TerrainCut selectCut(const EytIndex& index, const lod::ObjectView& view, double tauPixels);

}  // namespace eyrie::terrain
