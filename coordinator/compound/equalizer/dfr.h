// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coordinator/compound/equalizer/balancer.h"

namespace eyrie::equalizer {

/// Holds a frame rate by drawing its compound with fewer or more pixels (dynamic frame resolution):
/// the DFR equalizer of Equalizer. Time goes with the pixels' number, so that a side changes by the
/// square root of what is missing, a damped part of it a frame. What is missing is that of the
/// frame that took the time, which may have been planned some frames ago.
///
/// Frames that are to be complete have the pixels that are written, and tell it nothing.
///
/// From 128 pixels on the shorter side up to the size of the channel that draws, which may be more
/// than is shown, as far as renderers draw that.
class Dfr final : public Balancer {
public:
    Dfr(const config::Compound& written, std::size_t position, const Work& work);

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn& turn) override;
    void record(const PlannedFrame& frame, const FrameTimes& times) override;
    Report report() const override;
    std::unique_ptr<Balancer> clone() const override { return std::make_unique<Dfr>(*this); }

private:
    const std::size_t position_;
    const Work& work_;
    const fabric::Vec2 written_;
    double zoom_ = 1;             ///< both ways, on top of what is written
    double milliseconds_ = 0;     ///< of the last frame that is yet to be answered; 0: none
    double framesPerSecond_ = 0;  ///< of the last frame recorded
    double itsZoom_ = 1;
};

}  // namespace eyrie::equalizer
