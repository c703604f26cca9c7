// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "renderer/mesh/lod/patch.h"

namespace eyrie::mesh {

/// Points of a patch before it is simplified, by what keeps them.
struct PointCounts {
    std::uint64_t all = 0;
    /// Of all, those that stay for no other reason than that the patch ends there and the surface
    /// goes on.
    std::uint64_t onBorder = 0;
    std::uint64_t staying = 0;  ///< of all, those that have to stay whatever lies around the patch

    PointCounts& operator+=(const PointCounts& more);
    double borderShare() const { return shareOf(onBorder); }
    double stayingShare() const { return shareOf(staying); }

private:
    double shareOf(std::uint64_t some) const {
        return all > 0 ? static_cast<double>(some) / static_cast<double>(all) : 0;
    }
};

struct Simplified {
    Patch patch;
    PointCounts points;
    std::size_t target = 0;  ///< triangles to be left, those for points that stay counted in

    bool isDone() const { return patch.triangles.size() <= target; }
};

/// Of the mesh's vertices, which stay whatever it costs.
struct Staying {
    std::span<const std::uint8_t> everywhere;  ///< 1 for those that do so in every patch, else 0
    std::span<const std::uint8_t> sharedFrom;  ///< how deep nodes lie that have not all around it
    std::size_t depth = 0;                     ///< of the patch's node, the root at 0
};

/// Takes inner vertices of `patch` away, each time the one that makes the least bound, until about
/// `target` triangles, and half a one for each point that has to stay, are left or none can go:
/// beside edges that stay there are as many triangles as before, and the inside is not to make up
/// for them. Where more points stay than may go, as in soups, only as many count. What is left
/// keeps its promise (patch.h): each step is a map as described there, and their distances add up,
/// as do changes of colours and normals. Where those of colours are too much, the bound is how far
/// away the colours come from (patch_colours.h).
///
/// Stay: vertices on the border, so that the patch fits its neighbours whatever is done to them;
/// those where more than two sheets meet, or normals, colours, texture coordinates or materials are
/// broken; those of `staying`: where other sheets touch (sheet_ends.h) and where other nodes have
/// triangles, too (shared_points.h); and those whose star is no graph (star.h). A vertex that is
/// left keeps all that it has. R. Klein, G. Liebich, W. Straßer, "Mesh Reduction with Error
/// Control", 1996.
Simplified simplify(const PackedMesh& mesh, const Patch& patch, std::size_t target,
                    const Staying& staying);

}  // namespace eyrie::mesh
