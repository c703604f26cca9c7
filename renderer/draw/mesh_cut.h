// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "renderer/lod/view.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

/// Points are drawn for a node where each point of its surface has one within this, in pixels of
/// the view, and within half of tau; each then draws the pixels of which the middle is as near. So
/// no pixel of the surface is missed, and as the points themselves are as near to the source as
/// that, none is drawn that is farther from it than twice as much.
inline constexpr double kMostPointPixels = 0.25;
/// Added to what points are apart, for what rounding to a device's subpixels moves: 1/512 pixel
/// each way, of up to three of the view's pixels.
inline constexpr double kPointRounding = 1.0 / 128;
/// Where finer nodes are not there yet, points stand in for them up to this.
inline constexpr double kMostStandInPixels = 64;
/// No more points are drawn than make it this: what is thin looks thicker by as much.
inline constexpr double kEnoughPointPixels = 0.125;

/// A node in a view.
struct CutNode {
    std::uint32_t node = 0;
    int level = 0;             ///< 0: the root
    double errorPixels = 0;    ///< bound on what drawing it moves in the picture, colours too
    std::uint32_t points = 0;  ///< of a node of points: how many of them are enough
    double pointPixels = 0;    ///< of the same: how far its surface is from the nearest of them
};

/// What a view wants of a mesh, and what of it can be drawn with the nodes that are there.
struct MeshCut {
    std::vector<CutNode> wanted;   ///< the coarsest nodes that keep tau, or leaves, depth first
    std::vector<CutNode> drawn;    ///< what stands for them, depth first
    std::vector<CutNode> between;  ///< above wanted ones and below drawn ones, with geometry
    std::vector<CutNode> above;    ///< above drawn ones, with geometry
    /// Whether something is drawn for all that is seen.
    bool isWhole = true;

    /// The largest of the drawn nodes'; infinite where nothing is drawn for something seen.
    double errorPixels() const;
};

/// For a wanted node that is not there its children stand in if they are there, or theirs; else
/// the nearest node above that is. Without one, whatever there is of the children is drawn.
/// Without `mayBePoints` nodes of points are drawn by what is below them.
MeshCut cutOf(const mesh::EymFile& file, const lod::ObjectView& view, double tauPixels,
              const std::function<bool(std::uint32_t)>& isThere, bool mayBePoints = true);

}  // namespace eyrie::draw
