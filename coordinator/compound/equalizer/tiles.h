// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coordinator/compound/equalizer/balancer.h"

namespace eyrie::equalizer {

/// Has the drawing children of a compound fetch tiles of its picture, or chunks of its range, from
/// one queue (TileQueue) in place of drawing a part each: while it is on, the compound has
/// outputtiles, and those that draw below it have inputtiles, of a name that no other equalizer's
/// queue has. Each has all of the picture then. What is drawn for an output frame of a compound
/// between stays as it is written. The tile equalizer of Equalizer.
class Tiles final : public Balancer {
public:
    Tiles(const config::Compound& written, std::size_t position, const Work& work);

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn& turn) override;
    void record(const PlannedFrame&, const FrameTimes&) override {}
    Report report() const override { return {}; }
    std::unique_ptr<Balancer> clone() const override { return std::make_unique<Tiles>(*this); }

private:
    void set(Turn& turn, const std::optional<config::Tiles>& tiles) const;
    bool hasTakers(std::size_t child) const;

    const std::size_t position_;
    const Work& work_;
    const std::string name_;
    std::vector<std::size_t> takers_;
    std::vector<Part> written_;  ///< of the children
    bool isOn_ = false;
};

}  // namespace eyrie::equalizer
