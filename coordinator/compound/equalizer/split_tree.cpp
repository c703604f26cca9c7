// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/split_tree.h"

#include <bit>
#include <cmath>

namespace eyrie::equalizer {
namespace {

constexpr double kLeastShare = .01;  ///< of an equal part: what a part keeps, however slow
/// How much longer the other side must be before an area is cut the other way: then all of the
/// parts in it move at once, to places about which little is known.
constexpr double kClearlyLonger = 1.5;
/// Of a unit: a cut that is no farther off stays, so that it does not go to and fro between two.
constexpr double kNearer = .75;
/// A cut that turns back takes half the step, so that noise does not shake it; one that goes on a
/// longer one, up to twice what damping leaves. As in Riedmiller and Braun, "A Direct Adaptive
/// Method for Faster Backpropagation Learning: The RPROP Algorithm" (1993).
constexpr double kTurnedBack = .5;
constexpr double kWentOn = 1.5;
constexpr double kLeastStep = 1. / 64;
constexpr double kMostStep = 2;

double sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

double unitsIn(double length, double unit) { return std::ceil(length / unit - 1e-9); }

/// The places between which a cut leaves either side what it needs.
struct Bounds {
    double lowest;
    double highest;
};

}  // namespace

struct SplitTree::Split {
    double width;
    double height;
    const SplitRules& rules;
    const Place& place;
    std::vector<Area> parts;

    double whole(Axis axis) const { return axis == Axis::X ? width : height; }
    double unit(Axis axis) const { return axis == Axis::X ? rules.unitX : rules.unitY; }
    double resistance(Axis axis) const {
        return axis == Axis::X ? rules.resistanceX : rules.resistanceY;
    }
    bool hasRoom(const Area& area, Axis axis, std::size_t leaves) const {
        return unitsIn(area.length(axis), unit(axis)) >= static_cast<double>(leaves);
    }
};

SplitTree::SplitTree(std::size_t leaves)
    : nodes_(2 * std::bit_ceil(std::max<std::size_t>(leaves, 1))) {}

std::vector<Area> SplitTree::split(double width, double height, const SplitRules& rules,
                                   std::span<const double> resources, const Place& place) {
    resources_.assign(resources.begin(), resources.end());
    for (double& each : resources_) each = each > 0 && std::isfinite(each) ? each : 0;
    if (!(side(0, resources_.size()).leaves > 0))
        resources_.assign(resources_.size(), 1.0);
    const Area whole{0, 0, width, height};
    Split split{width, height, rules, place, std::vector<Area>(resources_.size(), whole)};
    if (resources_.size() > 1)
        cut(split, 0, 0, resources_.size(), 0, whole);
    return std::move(split.parts);
}

SplitTree::Side SplitTree::side(std::size_t first, std::size_t end) const {
    Side result;
    for (std::size_t leaf = first; leaf < end; ++leaf) {
        result.resources += resources_[leaf];
        result.leaves += resources_[leaf] > 0 ? 1 : 0;
    }
    return result;
}

void SplitTree::cut(Split& split, std::size_t index, std::size_t first, std::size_t end, int depth,
                    const Area& area) {
    if (end - first == 1) {
        split.parts[first] = area;
        return;
    }
    Node& node = nodes_[index];
    const std::size_t middle = first + (end - first) / 2;
    const Side left = side(first, middle);
    const Side right = side(middle, end);
    const Axis axis = axisOf(split, node, area, depth, left, right);
    const bool isKnown = node.cut && node.axis == axis && node.leavesBefore == left.leaves &&
                         node.leavesAfter == right.leaves;
    if (!isKnown)
        node = {std::nullopt, axis, left.leaves, right.leaves};
    double position = right.leaves == 0 ? area.end(axis) : area.begin(axis);
    if (left.leaves > 0 && right.leaves > 0) {
        Wish wish{area,        axis, first,
                  middle,      end,  left.resources / (left.resources + right.resources),
                  std::nullopt};
        if (node.cut)
            wish.before = *node.cut * split.whole(axis);
        position = move(split, node, wish, left, right);
        node.cut = split.whole(axis) > 0 ? position / split.whole(axis) : 0;
    }
    cut(split, 2 * index + 1, first, middle, depth + 1, before(area, axis, position));
    cut(split, 2 * index + 2, middle, end, depth + 1, from(area, axis, position));
}

Axis SplitTree::axisOf(const Split& split, const Node& node, const Area& area, int depth,
                       const Side& left, const Side& right) const {
    const CutAxes axes = split.rules.axes;
    if (axes == CutAxes::X || axes == CutAxes::Y)
        return axes == CutAxes::X ? Axis::X : Axis::Y;
    Axis axis = depth % 2 == 0 ? Axis::X : Axis::Y;
    if (axes == CutAxes::Longer) {
        const double width = area.length(Axis::X) * (node.axis == Axis::X ? kClearlyLonger : 1);
        const double height = area.length(Axis::Y) * (node.axis == Axis::Y ? kClearlyLonger : 1);
        axis = node.cut                                      ? (width > height ? Axis::X : Axis::Y)
               : area.length(Axis::X) > area.length(Axis::Y) ? Axis::X
                                                             : Axis::Y;
    }
    const std::size_t leaves = left.leaves + right.leaves;
    const Axis other = axis == Axis::X ? Axis::Y : Axis::X;
    return !split.hasRoom(area, axis, leaves) && split.hasRoom(area, other, leaves) ? other : axis;
}

/// How far `place` has gone on when the frame is drawn.
double SplitTree::ahead(const Split& split, Node& node, Axis axis, double place) {
    const double whole = split.whole(axis);
    return split.rules.followsCourse && whole > 0 ? node.course.ahead(place / whole) * whole : 0;
}

double SplitTree::move(const Split& split, Node& node, const Wish& wish, const Side& left,
                       const Side& right) {
    const double unit = split.unit(wish.axis);
    const double low = wish.area.begin(wish.axis);
    const double high = wish.area.end(wish.axis);
    const auto leavesBefore = static_cast<double>(left.leaves);
    const auto leavesAfter = static_cast<double>(right.leaves);
    const auto rounded = [&](double at) { return std::round(at / unit) * unit; };
    const auto boundsOf = [&](double share) {
        const double least = share * (high - low) / (leavesBefore + leavesAfter);
        const double before = std::max(unit * leavesBefore, least * leavesBefore);
        const double after = std::max(unit * (leavesAfter - 1), least * leavesAfter - unit);
        return Bounds{std::ceil((low + before) / unit - 1e-9) * unit,
                      (std::ceil((high - after) / unit - 1e-9) - 1) * unit};
    };
    Bounds bounds = boundsOf(kLeastShare);
    if (bounds.lowest > bounds.highest)
        bounds = boundsOf(0);
    if (bounds.lowest > bounds.highest)  // fewer units than leaves: some stay empty
        return std::clamp(rounded(low + wish.share * (high - low)), low, high);
    const double known = split.place(wish);
    const double onItsWay = ahead(split, node, wish.axis, known);
    const double place = known + onItsWay;
    const double goal = std::clamp(rounded(place), bounds.lowest, bounds.highest);
    if (!wish.before)
        return goal;
    const double before = std::clamp(rounded(*wish.before), bounds.lowest, bounds.highest);
    if (split.rules.isFrozen || (split.rules.isSettled && onItsWay == 0) || goal == before ||
        std::abs(place - before) <= std::max(split.resistance(wish.axis), kNearer * unit))
        return before;
    const double heading = sign(goal - before);
    node.step = std::clamp(node.step * (heading * node.heading < 0 ? kTurnedBack : kWentOn),
                           kLeastStep, kMostStep);
    node.heading = heading;
    const double way = std::min(1.0, (1 - split.rules.damping) * node.step);
    const double moved = rounded(before + way * (goal - before));
    return moved == before && way > 0 ? before + heading * unit : moved;
}

}  // namespace eyrie::equalizer
