// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coordinator/compound/equalizer/balancer.h"

namespace eyrie::equalizer {

/// Shows on its compound's channel what others show: output frames of their compounds are reduced
/// to the size that they have there, and put where they belong. The monitor equalizer of Equalizer.
///
/// For each input frame, the output frame of that name is to have as zoom the monitor's pixels for
/// each of the source's, by the segments' and views' places on their canvases: what it gets is for
/// all that take it (zoomMonitoredFrames). Where it comes needs no setting: what two destinations
/// show of a view is brought from one to the other to scale, unless the input frame says where to.
class Monitor final : public Balancer {
public:
    explicit Monitor(std::size_t position) : position_(position) {}

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn&) override { frames_.clear(); }
    void record(const PlannedFrame&, const FrameTimes&) override {}
    Report report() const override { return {}; }
    std::unique_ptr<Balancer> clone() const override { return std::make_unique<Monitor>(*this); }

private:
    struct Source {
        std::size_t position = 0;  ///< of the compound with the output frame
        std::size_t frame = 0;     ///< of its output frames
    };
    std::vector<MonitoredFrame> framesOf(const Turn& turn) const;
    /// Those of the monitor's tree that are drawn when it is, as for one eye each.
    std::vector<Source> sourcesOf(const Turn& turn, const std::string& name) const;

    const std::size_t position_;
    std::vector<MonitoredFrame> frames_;  ///< as of the last frame before it was frozen
};

}  // namespace eyrie::equalizer
