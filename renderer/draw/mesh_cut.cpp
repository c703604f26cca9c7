// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_cut.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace eyrie::draw {
namespace {

class CutMaker {
public:
    CutMaker(const mesh::EymFile& file, const lod::ObjectView& view, double tauPixels,
             const std::function<bool(std::uint32_t)>& isThere, bool mayBePoints)
        : file_(file),
          view_(view),
          tauPixels_(tauPixels),
          isThere_(isThere),
          mayBePoints_(mayBePoints) {}

    MeshCut make() && {
        cut_.isWhole = visit(0, 0, std::nullopt, false);
        if (!cut_.isWhole)
            moveBetween(0);
        return std::move(cut_);
    }

private:
    using Error = std::optional<double>;

    bool visit(std::uint32_t index, int level, Error error, bool hasStandIn);
    bool visitChildren(std::uint32_t index, int level, Error error, bool hasStandIn);
    bool draw(const CutNode& self, bool hasStandIn);
    CutNode pointNode(std::uint32_t index, int level, double errorMetres,
                      std::uint32_t points) const;
    std::optional<CutNode> asPoints(std::uint32_t index, int level) const;
    bool drawFiner(std::uint32_t index, int level, double error, bool hasStandIn);
    bool mayStandIn(const CutNode& node) const {
        return file_.nodes()[node.node].hasGeometry() && isThere_(node.node) &&
               (node.points == 0 || (mayBePoints_ && node.pointPixels <= kMostStandInPixels));
    }
    void moveBetween(std::size_t firstAbove) {
        cut_.between.insert(cut_.between.end(),
                            cut_.above.begin() + static_cast<std::ptrdiff_t>(firstAbove),
                            cut_.above.end());
        cut_.above.resize(firstAbove);
    }

    const mesh::EymFile& file_;
    const lod::ObjectView& view_;
    const double tauPixels_;
    const std::function<bool(std::uint32_t)>& isThere_;
    const bool mayBePoints_;
    MeshCut cut_;
};

/// A pixel may show a point at the end of its reach, which is as far from the source as the sample
/// is at most, and whose colour is from at the end of its own reach.
CutNode CutMaker::pointNode(std::uint32_t index, int level, double errorMetres,
                            std::uint32_t points) const {
    const fabric::Box box = file_.bounds(index);
    const double reach = file_.nodes()[index].colourReachMetres();
    const double off = view_.screenSpaceErrorPixels(errorMetres, box);
    const double ofColour = reach > 0 ? view_.screenSpaceErrorPixels(errorMetres + reach, box) : 0;
    return {index, level, std::max(2 * off, ofColour) + kPointRounding, points,
            off + kPointRounding};
}

/// The node drawn as no more of its points than are enough; nothing where these leave gaps.
std::optional<CutNode> CutMaker::asPoints(std::uint32_t index, int level) const {
    std::optional<CutNode> drawn;
    if (!mayBePoints_)
        return drawn;
    for (const mesh::PointRange& range : file_.pointRanges(index)) {
        const CutNode node = pointNode(index, level, range.errorMetres, range.points);
        if (node.pointPixels <= kMostPointPixels && node.errorPixels <= tauPixels_)
            drawn = node;
        if (node.pointPixels <= kEnoughPointPixels)
            break;
    }
    return drawn;
}

/// Depth first, so pieces come in the order of the range. A node's error bound covers its whole
/// subtree: below a node that keeps tau and has nothing to be drawn itself it is not computed
/// again. Returns whether something is drawn for all that is seen of the node.
bool CutMaker::visit(std::uint32_t index, int level, Error error, bool hasStandIn) {
    const mesh::Node& node = file_.nodes()[index];
    const fabric::Box box = file_.bounds(index);
    if (!view_.isVisible(box))
        return true;
    if (const std::optional<CutNode> points = asPoints(index, level))
        return draw(*points, hasStandIn);
    const bool wasKept = error.has_value() && !node.isOfPoints();
    if (!wasKept)
        error = view_.screenSpaceErrorPixels(node.farthestMetres(), box);
    const bool isKept = wasKept || node.isLeaf() || (*error <= tauPixels_ && !node.isOfPoints());
    const CutNode self = node.isOfPoints()
                             ? pointNode(index, level, node.errorMetres, node.vertexCount)
                             : CutNode{index, level, *error};
    if (isKept && node.hasGeometry())
        return draw(self, hasStandIn);
    const bool standsIn = !isKept && mayStandIn(self);
    const std::size_t firstDrawn = cut_.drawn.size();
    if (!isKept && node.hasGeometry() && (mayBePoints_ || !node.isOfPoints()))
        cut_.above.push_back(self);
    const std::size_t firstAbove = cut_.above.size();
    const bool isWhole =
        visitChildren(index, level, isKept ? error : std::nullopt, hasStandIn || standsIn);
    if (isWhole || !standsIn)
        return isWhole;
    cut_.drawn.resize(firstDrawn);
    cut_.drawn.push_back(self);
    moveBetween(firstAbove);
    return true;
}

bool CutMaker::visitChildren(std::uint32_t index, int level, Error error, bool hasStandIn) {
    const mesh::Node& node = file_.nodes()[index];
    const bool left = visit(static_cast<std::uint32_t>(node.left), level + 1, error, hasStandIn);
    const bool right = visit(static_cast<std::uint32_t>(node.right), level + 1, error, hasStandIn);
    return left && right;
}

bool CutMaker::draw(const CutNode& self, bool hasStandIn) {
    cut_.wanted.push_back(self);
    if (!isThere_(self.node))
        return drawFiner(self.node, self.level, self.errorPixels, hasStandIn);
    cut_.drawn.push_back(self);
    return true;
}

/// Errors are those of the node: they bound what lies under it. Finer points than those of a node
/// that may be drawn so may be, too.
bool CutMaker::drawFiner(std::uint32_t index, int level, double error, bool hasStandIn) {
    const mesh::Node& node = file_.nodes()[index];
    if (node.isLeaf())
        return false;
    bool isWhole = true;
    for (const std::int32_t next : {node.left, node.right}) {
        const auto child = static_cast<std::uint32_t>(next);
        if (!view_.isVisible(file_.bounds(child)))
            continue;
        if (const auto points = asPoints(child, level + 1); points && isThere_(child))
            cut_.drawn.push_back(*points);
        else if (file_.nodes()[child].indexCount > 0 && isThere_(child))
            cut_.drawn.push_back({child, level + 1, error});
        else
            isWhole = drawFiner(child, level + 1, error, hasStandIn) && isWhole;
        if (!isWhole && hasStandIn)
            return false;
    }
    return isWhole;
}

}  // namespace

double MeshCut::errorPixels() const {
    double worst = isWhole ? 0 : std::numeric_limits<double>::infinity();
    for (const CutNode& node : drawn) worst = std::max(worst, node.errorPixels);
    return worst;
}

MeshCut cutOf(const mesh::EymFile& file, const lod::ObjectView& view, double tauPixels,
              const std::function<bool(std::uint32_t)>& isThere, bool mayBePoints) {
    return CutMaker(file, view, tauPixels, isThere, mayBePoints).make();
}

}  // namespace eyrie::draw
