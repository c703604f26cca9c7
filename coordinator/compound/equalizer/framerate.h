// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>

#include "coordinator/compound/equalizer/balancer.h"

namespace eyrie::equalizer {

/// Spaces the frames of a time-multiplexed (DPlex) compound evenly: how often one may begin follows
/// from what those of a period took, and a twentieth to spare. Without it frames come in
/// bursts, as its children happen to end together. The framerate equalizer of Equalizer.
///
/// A frame's time is that of the pipe that took longest; n children that take turns make n frames
/// in it. A destination that takes longer to assemble, as far as its renderer tells, holds all up
/// by that.
class Framerate final : public Balancer {
public:
    Framerate(std::size_t position, const Work& work);

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn&) override { isAtWork_ = false; }
    void record(const PlannedFrame& frame, const FrameTimes& times) override;
    Report report() const override;
    double intervalMilliseconds() const override { return isAtWork_ ? interval_ : 0; }
    std::unique_ptr<Balancer> clone() const override { return std::make_unique<Framerate>(*this); }

private:
    const std::size_t position_;
    const Work& work_;
    const std::vector<std::size_t> children_;
    bool isAtWork_ = false;  ///< on, and what it spaces is shown
    bool isFrozen_ = false;
    std::size_t period_ = 1;
    std::deque<double> times_;  ///< milliseconds of the frames of the last period
    double assembly_ = 0;       ///< of the last frame
    double interval_ = 0;       ///< milliseconds between frames; 0: not known
};

}  // namespace eyrie::equalizer
