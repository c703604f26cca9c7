// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "renderer/draw/drawable.h"
#include "renderer/draw/mesh_cut.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

/// What of a node falls to a channel.
struct NodePart {
    double rangePosition = 0;  ///< Piece::rangePosition
    std::uint32_t firstTriangle = 0;
    std::uint32_t triangles = 0;  ///< from there on; 0 of points
};

/// Which nodes of a view's cut, and what of them, fall to a channel: its range is a share of the
/// mesh's work in the view, in the order of the data. So ranges of the same length have about as
/// much to draw from wherever one looks.
///
/// Every channel of a frame reckons with the same cut, the one that keeps the tau that was asked
/// for, whatever memory it has and whatever has arrived; so their shares meet exactly, and what
/// stands in for a node that is missing is drawn by each channel that the node falls to.
class NodeShares {
public:
    using NodeTest = std::function<bool(std::uint32_t)>;

    /// `wanted`: MeshCut::wanted of `request.view` at `request.tauPixels`, of which each node takes
    /// as much of the work as `work` says, above 0 and times anything. Nodes that `hasBlended` fall
    /// to every channel, beside the range that they start in.
    NodeShares(const mesh::EymFile& file, std::span<const CutNode> wanted,
               std::span<const double> work, const CutRequest& request, const NodeTest& hasBlended);

    /// Whether it is one of the wanted nodes that fall to the channel, or above or below one.
    bool isNeeded(std::uint32_t node) const;
    /// Leaves of a cut what is needed.
    void keepNeeded(MeshCut& cut) const;
    /// Of a needed node that is drawn.
    NodePart partOf(const CutNode& drawn) const;

private:
    /// A wanted node.
    struct Share {
        std::uint32_t node;
        std::uint64_t triangleEnd;  ///< mesh::Node's
        fabric::Range range;        ///< its own, of the mesh's work
        bool mayBeCut;              ///< several channels draw some of its triangles each
    };
    /// The first and the end of those that a node is one of, or above or below.
    struct Span {
        std::size_t first;
        std::size_t end;
        bool isEmpty() const { return first == end; }
    };

    bool fallsToChannel(const Share& share) const;
    double positionOf(const Share& share) const;
    double positionOf(const Span& empty) const;
    Span spanOf(const mesh::Node& node) const;

    const mesh::EymFile& file_;
    const fabric::Range range_;
    std::vector<Share> shares_;              ///< ascending
    std::vector<std::size_t> neededBefore_;  ///< how many of the first ones are needed
};

}  // namespace eyrie::draw
