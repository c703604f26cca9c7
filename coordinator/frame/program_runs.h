// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/compound/exchange.h"
#include "coordinator/frame/member.h"
#include "fabric/frame_data.h"

namespace eyrie::coordinator {

/// The programs of one frame, carried out by their renderers at the same time.
class ProgramRuns {
public:
    struct Setting {
        const fabric::FrameData& frameData;
        std::uint64_t sceneRevision = 0;
        std::uint64_t session = 0;  ///< fabric::ChannelProgram::session
        fabric::Rgba background;
        fabric::Completeness completeness = fabric::Completeness::Complete;
        bool measuresStages = false;
        std::chrono::milliseconds timeout{};
        std::function<void()> handedOut;  ///< called when the renderers have been given them
        std::function<void()> freed;      ///< called when one has done with its program
        std::stop_token stop = {};        ///< ends all
    };

    /// What came of them: pictures in the order of Exchange::rest's draws, and of each draw of the
    /// programs what it took.
    struct Result {
        std::vector<fabric::Image> pictures;
        struct Draw {
            std::size_t draw = 0;  ///< of the plan
            fabric::FrameStatistics statistics;
            std::string renderer;  ///< its id
        };
        std::vector<Draw> draws;
        fabric::DeviceInfo device;  ///< of the first renderer
    };

    /// `renderers` has one for each program, with its address; some may be the same. When one fails
    /// all end: the first error of one that was not ended by another's. It is not held against the
    /// renderer, whose peer may be the one that is gone.
    static absl::StatusOr<Result> run(const compound::Exchange& exchange, const Setting& setting,
                                      const std::vector<std::shared_ptr<Member>>& renderers,
                                      const std::vector<std::string>& addresses);
};

}  // namespace eyrie::coordinator
