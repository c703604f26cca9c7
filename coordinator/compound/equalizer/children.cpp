// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/children.h"

#include <algorithm>

namespace eyrie::equalizer {
namespace {

using config::SplitMode;

/// Ranges are cut at multiples of it unless a larger boundary is given: no piece of data is so
/// small.
constexpr double kRangeUnit = 1.0 / (1 << 20);

CutAxes axesOf(SplitMode mode) {
    switch (mode) {
        case SplitMode::Horizontal:
            return CutAxes::Y;
        case SplitMode::TwoD:
            return CutAxes::Longer;
        case SplitMode::Vertical:
        case SplitMode::Db:
            break;
    }
    return CutAxes::X;
}

}  // namespace

Children::Children(const config::Compound& written, std::size_t position, const Work& work)
    : parent_(position), work_(work) {
    const std::vector<std::size_t>& all = work.at(position).children;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!work.at(all[i]).draws)
            continue;
        positions_.push_back(all[i]);
        const config::Compound& child = written.children[i];
        written_.push_back({child.viewport, child.range, false});
        isShared_ =
            isShared_ || child.viewport != config::Viewport{} || child.range != fabric::Range{};
    }
}

std::vector<double> Children::resources(const Turn& turn) const {
    std::vector<double> resources;
    for (const std::size_t child : positions_) resources.push_back(turn.resources(child));
    return resources;
}

std::optional<std::vector<double>> Children::costs(const PlannedFrame& frame,
                                                   const FrameTimes& times) const {
    std::vector<double> costs;
    for (const std::size_t child : positions_) {
        const auto cost = work_.cost(child, frame, times);
        if (!cost)
            return std::nullopt;
        costs.push_back(*cost);
    }
    return costs;
}

Area Children::part(std::size_t child, const PlannedFrame& frame, SplitMode mode) const {
    const Part& part = frame.parts[positions_[child]];
    if (mode == SplitMode::Db)
        return {part.range.begin, 0, part.range.end, 1};
    const config::Viewport& v = part.viewport;
    return {v.x, v.y, v.x + v.width, v.y + v.height};
}

void Children::give(Turn& turn, SplitMode mode, double width, double height,
                    std::span<const Area> parts) const {
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        config::Compound& child = *turn.live[positions_[i]];
        const Area& part = parts[i];
        child.viewport = {};
        child.range = {};
        if (mode == SplitMode::Db)
            child.range = {part.x / width, part.xEnd / width};
        else
            child.viewport = {part.x / width, part.y / height, (part.xEnd - part.x) / width,
                              (part.yEnd - part.y) / height};
    }
}

void Children::giveAsWritten(Turn& turn, SplitMode mode) const {
    const config::ResolvedCompound* const compound = turn.resolved(parent_);
    config::Equalizer inTheMode;
    inTheMode.mode = mode;
    const auto whole =
        compound == nullptr || isShared_ ? std::nullopt : wholeOf(*compound, inTheMode);
    if (whole) {
        const auto evenly = [](const SplitTree::Wish& wish) {
            return wish.area.begin(wish.axis) + wish.share * wish.area.length(wish.axis);
        };
        const std::vector<Area> parts = SplitTree(size()).split(
            whole->width, whole->height, whole->rules, resources(turn), evenly);
        return give(turn, mode, whole->width, whole->height, parts);
    }
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        turn.live[positions_[i]]->viewport = written_[i].viewport;
        turn.live[positions_[i]]->range = written_[i].range;
    }
}

std::optional<Whole> wholeOf(const config::ResolvedCompound& compound,
                             const config::Equalizer& settings) {
    if (compound.pixelViewport.isEmpty())
        return std::nullopt;
    Whole whole;
    SplitRules& rules = whole.rules;
    rules.axes = axesOf(settings.mode);
    rules.damping = settings.damping;
    if (settings.mode == SplitMode::Db) {
        rules.unitX = std::max(settings.boundaryRange.value_or(0), kRangeUnit);
        rules.resistanceX = settings.resistanceRange.value_or(0);
        return whole;
    }
    whole.width = compound.pixelViewport.width;
    whole.height = compound.pixelViewport.height;
    const fabric::Vec2 boundary = settings.boundaryPixels.value_or(fabric::Vec2(1, 1));
    const fabric::Vec2 resistance = settings.resistancePixels.value_or(fabric::Vec2(0, 0));
    rules.unitX = std::max(1.0, boundary.x);
    rules.unitY = std::max(1.0, boundary.y);
    rules.resistanceX = resistance.x;
    rules.resistanceY = resistance.y;
    return whole;
}

Area shareOf(const Area& area, const Whole& whole) {
    return {area.x / whole.width, area.y / whole.height, area.xEnd / whole.width,
            area.yEnd / whole.height};
}

}  // namespace eyrie::equalizer
