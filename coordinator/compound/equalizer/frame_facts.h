// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/resolved.h"

namespace eyrie::equalizer {

/// What is known before a frame is planned.
struct FrameFacts {
    std::uint64_t frameNumber = 0;
    /// The configuration as it is written, without what equalizers have made of it, in the sizes
    /// that it is drawn in. Only sizes, channels, periods and destinations of compounds are read.
    const config::ResolvedConfiguration& resolved;
    /// Channels whose renderer is away. They get no share until they are back.
    std::vector<config::ChannelIndex> gone = {};
    bool isComplete = false;  ///< it is to have all that is asked for, whatever time that takes
    std::vector<std::size_t> canvases = {};  ///< that it is asked for; none: all
};

/// What the tasks of one compound took in a frame, milliseconds. Not a number, or negative: not
/// known, or not done in this frame.
struct CompoundTime {
    static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

    double draw = kUnknown;  ///< clearing and drawing, of all its tiles
    double readback = 0;
    double transmit = 0;  ///< encoding and decoding included
    /// Of its input frames, without waiting for them; 0 where that costs its channel nothing, as
    /// where the coordinator puts pictures together, or where its renderer does not tell.
    double assemble = 0;
    /// What of the compound's own picture was covered, a fraction of that from its lower left
    /// corner.
    config::Viewport covered;
};

struct FrameTimes {
    std::uint64_t frameNumber = 0;  ///< that of FrameFacts
    /// By position in ResolvedConfiguration::compounds; what is left out is not known.
    std::vector<CompoundTime> compounds;
};

}  // namespace eyrie::equalizer
