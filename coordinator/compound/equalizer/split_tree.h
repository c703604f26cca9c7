// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "coordinator/compound/equalizer/area.h"
#include "coordinator/compound/equalizer/course.h"

namespace eyrie::equalizer {

/// Which way areas are cut.
enum class CutAxes {
    X,
    Y,
    Longer,      ///< as their pixels have it, which keeps parts near square
    Alternating  ///< x first, then y within the halves, and so on
};

struct SplitRules {
    CutAxes axes = CutAxes::Longer;
    /// Cuts lie at multiples of it on x and y; above 0. A whole pixel or more, or a share of data.
    double unitX = 1;
    double unitY = 1;
    /// A cut stays where it is when the place for it is no farther off.
    double resistanceX = 0;
    double resistanceY = 0;
    double damping = .5;    ///< share of the way to that place not gone at first; 0 to 1
    bool isFrozen = false;  ///< cuts stay as long as the same leaves have parts
    /// Cuts go to where the place for them will be, not to where it is (Course).
    bool followsCourse = false;
    bool isSettled = false;  ///< cuts stay, but for one whose place is on its way
};

/// Cuts an area into parts, one for each leaf of a balanced binary tree, which meet on both sides
/// of each inner node's cut. Where the cuts were stays known, so that they move from there.
///
/// The tree is that of Equalizer (Eilemann, Makhinya, Pajarola 2009). There damping is towards the
/// middle of the area; here it is towards where the cut was (docs/decisions/0040).
class SplitTree {
public:
    explicit SplitTree(std::size_t leaves);

    /// A cut to be made.
    struct Wish {
        Area area;
        Axis axis = Axis::X;
        std::size_t firstLeaf = 0;  ///< of those on either side of it
        std::size_t middleLeaf = 0;
        std::size_t endLeaf = 0;
        double share = .5;             ///< of the resources that lie before the cut
        std::optional<double> before;  ///< where it was
    };
    /// Where the cut should be, in the area's coordinates.
    using Place = std::function<double(const Wish&)>;

    /// The parts, by leaf, of an area of (0, 0) to (width, height): they cover it once. Those of
    /// leaves without `resources` (0 or less; where none has any, all count as equal) are empty;
    /// all others have a unit or more where there are as many units on both axes as leaves.
    std::vector<Area> split(double width, double height, const SplitRules& rules,
                            std::span<const double> resources, const Place& place);

private:
    struct Node {
        std::optional<double> cut;  ///< share of the whole width or height
        Axis axis = Axis::X;
        std::size_t leavesBefore = 0;  ///< with resources, before and after the cut
        std::size_t leavesAfter = 0;
        double step = 1;     ///< for each of what damping leaves
        double heading = 0;  ///< which way the cut wanted to move
        Course course = {};  ///< of the place for the cut
    };
    struct Side {
        double resources = 0;
        std::size_t leaves = 0;  ///< with resources
    };
    struct Split;

    Side side(std::size_t first, std::size_t end) const;
    void cut(Split& split, std::size_t node, std::size_t first, std::size_t end, int depth,
             const Area& area);
    Axis axisOf(const Split& split, const Node& node, const Area& area, int depth, const Side& left,
                const Side& right) const;
    static double ahead(const Split& split, Node& node, Axis axis, double place);
    double move(const Split& split, Node& node, const Wish& wish, const Side& left,
                const Side& right);

    std::vector<double> resources_;
    std::vector<Node> nodes_;  ///< of a heap: children of i are 2i + 1 and 2i + 2
};

}  // namespace eyrie::equalizer
