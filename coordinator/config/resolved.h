// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"
#include "coordinator/config/screen.h"
#include "fabric/viewport.h"

/// What follows from a configuration: where views are shown, and what every compound does with all
/// that it inherits.
namespace eyrie::config {

/// A view where it falls on a segment.
struct Destination {
    DestinationIndex index;
    ChannelIndex channel;                 ///< of the segment
    std::string name;                     ///< that of the channel
    Viewport viewport;                    ///< of the segment, a fraction
    fabric::PixelViewport pixelViewport;  ///< in the channel's window
    Eyes eyes;                            ///< that the view shows and the segment has
    /// The wall that is seen through it; nothing where neither view, segment nor canvas has one:
    /// the picture is the camera's own.
    std::optional<Wall> wall;
};

/// What one eye sees of a compound's part.
struct EyeSight {
    enum class Eye { Cyclop, Left, Right };
    Eye eye = Eye::Cyclop;
    std::optional<Sight> sight;  ///< nothing: the eye is not before the wall
};

struct ResolvedFrame {
    std::string name;        ///< with what it is called by default
    bool isMatched = false;  ///< an output frame somebody takes, an input frame somebody makes
    const Frame* frame = nullptr;
};

struct ResolvedCompound {
    const Compound* compound = nullptr;      ///< null: implicit, the plain picture of a destination
    int depth = 0;                           ///< 0: a root
    std::optional<std::size_t> destination;  ///< in ResolvedConfiguration::destinations
    std::optional<ChannelIndex> channel;     ///< that does the tasks
    fabric::PixelViewport pixelViewport;     ///< that is drawn, after pixel and zoom
    Viewport viewport;                       ///< of the destination; exact for pixelViewport
    fabric::Range range;
    PixelShare pixel;
    SubPixelShare subpixel;
    fabric::Vec2 zoom{1, 1};
    std::int64_t period = 1;
    std::int64_t phase = 0;
    Eyes eyes;
    Buffers buffers;
    Tasks tasks;
    std::vector<ResolvedFrame> outputFrames;
    std::vector<ResolvedFrame> inputFrames;
    std::vector<EyeSight> sights;  ///< where it draws and there is a wall
};

/// Refers to its configuration.
struct ResolvedConfiguration {
    std::vector<Destination> destinations;
    /// Roots with their children after them, as written; implicit ones last.
    std::vector<ResolvedCompound> compounds;
};

/// Pixels of a pipe whose configuration does not say: without a screen nothing else does.
inline constexpr fabric::PixelViewport kPipePixels{0, 0, 1920, 1080};

/// `configuration` outlives what is returned, which is to be used only where `findings` has no
/// errors. Warnings say what has no effect, such as frames that nobody makes.
ResolvedConfiguration resolve(const Configuration& configuration, Findings& findings);

}  // namespace eyrie::config
