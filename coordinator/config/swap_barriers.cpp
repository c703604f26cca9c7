// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/swap_barriers.h"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

std::string nameOf(const SwapBarrier& barrier, const std::string& otherwise) {
    return barrier.name.empty() ? otherwise : barrier.name;
}

/// Gives segments that have none yet those of compounds, from the roots down.
class CompoundWalk {
public:
    CompoundWalk(std::size_t canvas, const std::optional<std::size_t>& layout,
                 std::vector<std::string>& segments)
        : canvas_(canvas), layout_(layout), segments_(segments) {}

    void visitRoots(const std::vector<Compound>& roots) {
        for (std::size_t i = 0; i < roots.size(); ++i)
            visit(roots[i], "", fmt::format("compound {}", i));
    }

private:
    /// `unnamed`: what barriers without a name are called.
    void visit(const Compound& compound, const std::string& inherited, const std::string& unnamed) {
        const std::string own =
            compound.swapBarrier ? nameOf(*compound.swapBarrier, unnamed) : inherited;
        if (const auto* shown = std::get_if<DestinationIndex>(&compound.channel);
            shown != nullptr && shown->canvas == canvas_ && shown->layout == layout_ &&
            shown->segment < segments_.size() && segments_[shown->segment].empty())
            segments_[shown->segment] = own;
        for (const Compound& child : compound.children) visit(child, own, unnamed);
    }

    const std::size_t canvas_;
    const std::optional<std::size_t> layout_;
    std::vector<std::string>& segments_;
};

}  // namespace

CanvasBarriers swapBarriers(const Configuration& configuration, std::size_t canvas,
                            const std::optional<std::size_t>& layout) {
    const Canvas& shown = configuration.canvases[canvas];
    CanvasBarriers barriers;
    const std::string unnamed = fmt::format("canvas {}", canvas);
    if (shown.swapBarrier)
        barriers.whole = nameOf(*shown.swapBarrier, unnamed);
    for (const Segment& segment : shown.segments)
        barriers.segments.push_back(segment.swapBarrier ? nameOf(*segment.swapBarrier, unnamed)
                                                        : barriers.whole);
    CompoundWalk(canvas, layout, barriers.segments).visitRoots(configuration.compounds);
    const bool areShared =
        std::ranges::adjacent_find(barriers.segments, std::ranges::not_equal_to()) ==
        barriers.segments.end();
    if (barriers.whole.empty() && areShared && !barriers.segments.empty())
        barriers.whole = barriers.segments.front();
    return barriers;
}

}  // namespace eyrie::config
