// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/compound/equalizer/balancer.h"

namespace eyrie::equalizer {

/// Shows on its compound's channel what others show: output frames of their compounds are reduced
/// to the size that they have there, and put where they belong. The monitor equalizer of Equalizer.
///
/// For each input frame, the output frame of that name gets as zoom the monitor's pixels for each
/// of the source's, and the input frame as viewport the place of the source's picture in the
/// monitor's, from the segments' and views' places on their canvases; that may reach beyond it.
class Monitor final : public Balancer {
public:
    Monitor(const config::Compound& written, std::size_t position);

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn& turn) override;
    void record(const PlannedFrame&, const FrameTimes&) override {}
    Report report() const override { return {}; }

private:
    struct Source {
        std::size_t position = 0;  ///< of the compound with the output frame
        std::size_t frame = 0;     ///< of its output frames
        fabric::Vec2 written{1, 1};
    };
    std::optional<Source> sourceOf(const Turn& turn, const std::string& name) const;

    const std::size_t position_;
    const std::vector<config::Frame> written_;  ///< its input frames
    std::vector<Source> zoomed_;                ///< what it changed
};

}  // namespace eyrie::equalizer
