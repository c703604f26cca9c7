// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/compound/exchange.h"
#include "coordinator/compound/plan.h"
#include "coordinator/compound/tiling.h"
#include "coordinator/frame/active_configuration.h"
#include "coordinator/frame/crew.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/member.h"
#include "coordinator/frame/takers.h"
#include "fabric/frame_data.h"

namespace eyrie::coordinator {

/// All that has been decided about a frame before it is drawn: what happens to configuration,
/// scene and renderers meanwhile is for the next ones.
struct PlannedFrame {
    FrameRequest request;  ///< as large as its budget allows
    Crew::State scene;
    std::vector<std::shared_ptr<Member>> members;  ///< those that were ready
    std::uint64_t number = 0;                      ///< ascending from 1
    std::uint64_t kind = 0;                        ///< FrameKinds
    std::uint64_t revision = 0;                    ///< PictureRevision
    double intervalMilliseconds = 0;               ///< ActiveConfiguration::intervalMilliseconds
    std::string timeLine;  ///< of traces, where frames at the same time have different ones
    fabric::FrameData frameData;
    std::shared_ptr<ActiveConfiguration> configuration;
    compound::Plan plan;
    Takers takers;  ///< of members, for each draw of the plan
    /// Renderers are asked to encode them; empty: they are asked for pixels.
    std::vector<compound::Tile> tiles;

    /// The same by programs, where it can be; positions are of members.
    struct ByPrograms {
        compound::Exchange exchange;
        std::vector<std::size_t> renderers;  ///< for each program
        compound::Plan others;               ///< what they leave to be drawn
        Takers takers;                       ///< for each draw of that
    };
    std::optional<ByPrograms> byPrograms;
};

}  // namespace eyrie::coordinator
