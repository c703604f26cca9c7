// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "coordinator/compound/equalizer/balancer.h"

namespace eyrie::equalizer {

/// Shares out pipes between the output segments of a wall: one child a segment, each with an
/// equalizer of its own below that keeps to the shares. The view equalizer of Equalizer
/// (Eilemann, Makhinya, Pajarola 2009).
///
/// A segment gets of all pipes what its work is of all work, a tenth of a pipe at least: of its own
/// pipe first, then of those that it used before, then of others, which may serve two segments
/// each. The work is what all its compounds took, transmission and assembly included; Equalizer
/// takes transmission with the wrong sign, and guesses the work from the time by the square root
/// of the number of pipes.
class View final : public Balancer {
public:
    /// `position` of the compound whose drawing children are the segments.
    View(std::size_t position, const Work& work);

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn&) override {}  // all keep all of what they may use
    void record(const PlannedFrame& frame, const FrameTimes& times) override;
    Report report() const override;
    std::unique_ptr<Balancer> clone() const override { return std::make_unique<View>(*this); }

private:
    using Pipe = std::pair<std::size_t, std::size_t>;  ///< node, pipe
    /// What one segment has of each pipe, 0 to 1.
    using Shares = std::map<Pipe, double>;

    struct Supply;
    std::vector<Shares> share(const Turn& turn) const;
    std::vector<double> demands(double pipes) const;
    void use(Turn& turn, const std::vector<Shares>& shares) const;

    const Work& work_;
    const std::vector<std::size_t> children_;
    std::vector<double> loads_;   ///< milliseconds of all pipes together, by child; damped
    std::vector<Shares> shares_;  ///< of the last frame, by child
};

}  // namespace eyrie::equalizer
