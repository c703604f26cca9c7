// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coordinator/compound/equalizer/balancer.h"
#include "coordinator/compound/equalizer/children.h"
#include "coordinator/compound/equalizer/load_model.h"

namespace eyrie::equalizer {

/// Shares out a compound's picture (2D, HORIZONTAL, VERTICAL) or range (DB) between its children so
/// that all take equally long: the load equalizer of Equalizer (Eilemann, Makhinya, Pajarola 2009).
///
/// From frames of which all times are known it learns where the load lies and who is slow
/// (LoadModel) and moves the cuts of a SplitTree so that each side has of the load what it has of
/// the resources. What a destination assembles, as far as its renderer tells, is charged to the
/// child that draws on its channel.
/// Times within a twentieth of each other are left alone: moving a cut costs, because what lies
/// there has to be loaded by another renderer. A cut whose place moves frame after frame, as where
/// the camera turns, goes ahead of it.
class Load final : public Balancer {
public:
    Load(const config::Compound& written, std::size_t position, const Work& work);

    void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) override;
    void switchOff(Turn& turn) override;
    void record(const PlannedFrame& frame, const FrameTimes& times) override;
    Report report() const override;
    std::unique_ptr<Balancer> clone() const override { return std::make_unique<Load>(*this); }

private:
    void setMode(config::SplitMode mode);
    std::vector<double> resources(const Turn& turn, const config::Equalizer& settings) const;
    void charge(std::vector<double>& resources, std::size_t destination) const;
    double imbalance() const;

    const std::size_t position_;
    const Work& work_;
    const Children children_;
    config::SplitMode mode_ = config::SplitMode::TwoD;
    LoadModel model_;
    SplitTree tree_;
    std::vector<double> resources_;  ///< of the last frame planned, by child
    std::vector<double> costs_;      ///< of the last frame recorded, by child; empty: none yet
    double assembly_ = 0;            ///< of that frame
    std::size_t destination_;        ///< the child on the compound's channel; past the last: none
};

}  // namespace eyrie::equalizer
