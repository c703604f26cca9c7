// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/display.h"
#include "coordinator/config/findings.h"
#include "coordinator/config/screen.h"
#include "fabric/regridding.h"
#include "fabric/viewport.h"

/// What follows from a configuration: where views are shown, and what every compound does with all
/// that it inherits.
namespace eyrie::config {

/// The picture that destinations are parts of: of the whole canvas, of a segment or of a view,
/// whichever has the wall, so that neighbours show one picture without a seam. The whole view
/// where there is no wall.
struct Panorama {
    std::int32_t width = 0;
    std::int32_t height = 0;
    std::optional<Wall> wall;    ///< nothing: the camera's own picture
    fabric::PixelViewport view;  ///< where the layout's view is; may reach beyond it

    bool operator==(const Panorama&) const = default;
};

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
    bool isShown = true;                    ///< the canvas shows this layout
    PixelSize canvas;                       ///< nearest whole pixels where segments differ
    fabric::PixelViewport segmentOnCanvas;  ///< in those
    fabric::PixelViewport onSegment;        ///< from the segment's lower left corner
    Panorama panorama;
    fabric::PixelViewport partOfPanorama;
    double widening = 1;  ///< of walls, from the configured shape of the canvas to that shown
};

/// What one eye sees of a compound's part.
struct EyeSight {
    enum class Eye { Cyclop, Left, Right };
    Eye eye = Eye::Cyclop;
    std::optional<fabric::Sight> sight;  ///< nothing: the eye is not before the wall
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
    /// From the destination's pixels to those that are drawn; none: they are the same.
    std::vector<fabric::Regridding> regriddings;
    /// What is drawn in those: of the destination, from its lower left corner, or of what the last
    /// regridding makes.
    fabric::PixelViewport area;
    Viewport viewport;  ///< of the destination; exact for pixelViewport
    fabric::Range range;
    PixelShare pixel;
    SubPixelShare subpixel;
    fabric::Vec2 zoom{1, 1};
    std::int64_t period = 1;
    std::int64_t phase = 0;
    Eyes eyes;
    Buffers buffers;
    std::optional<Wall> wall;  ///< instead of its destination's
    Tasks tasks;
    std::vector<ResolvedFrame> outputFrames;
    std::vector<ResolvedFrame> inputFrames;
    std::vector<EyeSight> sights;  ///< where it draws and there is a wall

    Place place() const { return compound != nullptr ? compound->place : Place{}; }
};

/// Whether two are drawn for one eye in one frame.
bool meet(const ResolvedCompound& a, const ResolvedCompound& b);

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
/// Destinations and compounds are the same, in the same order, whatever is on display.
ResolvedConfiguration resolve(const Configuration& configuration, Findings& findings);
ResolvedConfiguration resolve(const Configuration& configuration, const Display& display,
                              Findings& findings);

}  // namespace eyrie::config
