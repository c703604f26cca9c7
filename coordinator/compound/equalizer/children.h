// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/compound/equalizer/balancer.h"
#include "coordinator/compound/equalizer/split_tree.h"

namespace eyrie::equalizer {

/// The children of a compound between which its picture or its range is shared out.
class Children {
public:
    Children(const config::Compound& written, std::size_t position, const Work& work);

    std::size_t size() const { return positions_.size(); }
    std::size_t operator[](std::size_t child) const { return positions_[child]; }

    std::vector<double> resources(const Turn& turn) const;

    /// What each took; nothing unless all times are known.
    std::optional<std::vector<double>> costs(const PlannedFrame& frame,
                                             const FrameTimes& times) const;

    /// The child's part of the whole, both from 0 to 1.
    Area part(std::size_t child, const PlannedFrame& frame, config::SplitMode mode) const;

    /// Gives each child its part of a whole of `width` x `height`: all data in a part of the
    /// picture, or in all of it a part of the data, whatever is written.
    void give(Turn& turn, config::SplitMode mode, double width, double height,
              std::span<const Area> parts) const;

    /// As they are written or, where that is everything for everyone, in equal parts.
    void giveAsWritten(Turn& turn, config::SplitMode mode) const;

private:
    std::size_t parent_;
    const Work& work_;
    std::vector<std::size_t> positions_;
    std::vector<Part> written_;
    bool isShared_ = false;  ///< what is written differs between children
};

/// What is cut in a mode, and how: pixels of a compound's picture, or [0, 1) of its range.
struct Whole {
    double width = 1;
    double height = 1;
    SplitRules rules;
};
/// Nothing while the picture has no pixels, as of groups of destinations, which have none of their
/// own.
std::optional<Whole> wholeOf(const config::ResolvedCompound& compound,
                             const config::Equalizer& settings);

/// `area` of `whole` as a share of it.
Area shareOf(const Area& area, const Whole& whole);

}  // namespace eyrie::equalizer
