// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "coordinator/compound/equalizer/balancer.h"
#include "coordinator/compound/equalizer/children.h"

namespace eyrie::equalizer {

/// Shares out a compound's picture or range between its children as Load does, but knows less: each
/// cut is moved by what the two sides of it took in the last frame and no more, as if load were
/// even on either. With frames in flight cuts wait for the first frame that they were in: what one
/// before it took belongs to others. Pictures are cut by turns across and along. What a destination
/// assembles, and where parts were covered, does not count. The tree equalizer of Equalizer.
class Tree final : public Balancer {
public:
    Tree(const config::Compound& written, std::size_t position, const Work& work);

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn& turn) override;
    void record(const PlannedFrame& frame, const FrameTimes& times) override;
    Report report() const override;
    std::unique_ptr<Balancer> clone() const override { return std::make_unique<Tree>(*this); }

private:
    double sum(std::size_t first, std::size_t end, const std::vector<double>& values) const;

    const std::size_t position_;
    const Children children_;
    config::SplitMode mode_ = config::SplitMode::TwoD;
    SplitTree tree_;
    std::vector<double> resources_;  ///< of the last frame planned, by child
    std::vector<double> costs_;      ///< of the last frame recorded that is yet to be answered
    std::vector<Area> parts_;        ///< of the last frame planned, by child
    std::uint64_t since_ = 0;        ///< the first frame planned with these
    double imbalance_ = 0;
};

}  // namespace eyrie::equalizer
