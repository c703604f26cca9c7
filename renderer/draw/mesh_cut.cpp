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
             const std::function<bool(std::uint32_t)>& isThere)
        : file_(file), view_(view), tauPixels_(tauPixels), isThere_(isThere) {}

    MeshCut make() && {
        cut_.isWhole = visit(0, 0, std::nullopt, false);
        if (!cut_.isWhole)
            moveBetween(0);
        return std::move(cut_);
    }

private:
    using Error = std::optional<double>;

    bool visit(std::uint32_t index, int level, Error error, bool hasStandIn);
    bool drawFiner(std::uint32_t index, int level, double error, bool hasStandIn);
    bool isDrawable(std::uint32_t index) const {
        return file_.nodes()[index].indexCount > 0 && isThere_(index);
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
    MeshCut cut_;
};

/// Depth first, so pieces come in the order of the range. A node's error bound covers its whole
/// subtree: below a node that keeps tau and has nothing to be drawn itself it is not computed
/// again. Returns whether something is drawn for all that is seen of the node.
bool CutMaker::visit(std::uint32_t index, int level, Error error, bool hasStandIn) {
    const mesh::Node& node = file_.nodes()[index];
    const fabric::Box box = file_.bounds(index);
    if (!view_.isVisible(box))
        return true;
    const bool wasKept = error.has_value();
    if (!wasKept)
        error = view_.screenSpaceErrorPixels(node.errorMetres, box);
    const bool isKept = wasKept || node.isLeaf() || *error <= tauPixels_;
    const CutNode self{index, level, *error};
    if (isKept && node.indexCount > 0) {
        cut_.wanted.push_back(self);
        if (!isThere_(index))
            return drawFiner(index, level, *error, hasStandIn);
        cut_.drawn.push_back(self);
        return true;
    }
    const bool mayStandIn = !isKept && isDrawable(index);
    const std::size_t firstDrawn = cut_.drawn.size();
    if (!isKept && node.indexCount > 0)
        cut_.above.push_back(self);
    const std::size_t firstAbove = cut_.above.size();
    const Error known = isKept ? error : std::nullopt;
    const bool left =
        visit(static_cast<std::uint32_t>(node.left), level + 1, known, hasStandIn || mayStandIn);
    const bool right =
        visit(static_cast<std::uint32_t>(node.right), level + 1, known, hasStandIn || mayStandIn);
    if ((left && right) || !mayStandIn)
        return left && right;
    cut_.drawn.resize(firstDrawn);
    cut_.drawn.push_back(self);
    moveBetween(firstAbove);
    return true;
}

/// Errors are those of the node: they bound what lies under it.
bool CutMaker::drawFiner(std::uint32_t index, int level, double error, bool hasStandIn) {
    const mesh::Node& node = file_.nodes()[index];
    if (node.isLeaf())
        return false;
    bool isWhole = true;
    for (const std::int32_t next : {node.left, node.right}) {
        const auto child = static_cast<std::uint32_t>(next);
        if (!view_.isVisible(file_.bounds(child)))
            continue;
        if (isDrawable(child))
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
              const std::function<bool(std::uint32_t)>& isThere) {
    return CutMaker(file, view, tauPixels, isThere).make();
}

}  // namespace eyrie::draw
