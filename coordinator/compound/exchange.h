// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "coordinator/compound/plan.h"
#include "fabric/channel_program.h"

namespace eyrie::compound {

/// What one renderer does of a plan by itself.
struct PlannedProgram {
    config::ChannelIndex channel;
    /// Without session, background, and addresses: outputs for other programs name them by
    /// `takers`.
    fabric::ChannelProgram program;
    std::vector<std::size_t> draws;  ///< of the plan, in the order in which the program has them
    /// For each output of each stage, in order, the program that takes it; nothing: it goes into
    /// the answer.
    std::vector<std::optional<std::size_t>> takers;
};

/// A plan whose renderers send each other what the coordinator need not see.
struct Exchange {
    std::vector<PlannedProgram> programs;
    /// What is left for the coordinator. Its draws are `draws` of the plan, then the programs'
    /// answers, in their order: composePictures takes both as drawn.
    Plan rest;
    std::vector<std::size_t> draws;
};

/// The plan as programs: framebuffers that are no destination's whole, of a destination's what is
/// done until its last picture leaves for another. Nothing where no program takes a picture of
/// another, where a step is none that programs have, or where there is a queue: then it is carried
/// out centrally.
std::optional<Exchange> exchangeOf(const Plan& plan, std::uint64_t frameNumber);

}  // namespace eyrie::compound
