// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "coordinator/config/findings.h"
#include "fabric/range.h"
#include "fabric/vec.h"

/// A configuration as it is written: which resources there are, what they show, and how compounds
/// share the work. In the terms of Equalizer (Eilemann, Makhinya, Pajarola: "Equalizer: A Scalable
/// Parallel Rendering Framework", 2009), whose files are one form of it. What follows from it, such
/// as destination channels, is in ResolvedConfiguration.
///
/// Things refer to each other by index in the lists here; optional values that are absent are
/// inherited or have their usual value. Lengths are metres, y up, the viewer looking down -z.
namespace eyrie::config {

/// A setting of a resource by its name in the file, such as hint_stereo ON.
struct Attribute {
    std::string name;
    /// Words such as ON or FBO, or, of masks, any number of them.
    struct Words {
        std::vector<std::string> words;
        bool operator==(const Words&) const = default;
    };
    std::variant<Words, std::int64_t, double, std::string> value;
    Place place = {};

    bool operator==(const Attribute&) const = default;
};
using Attributes = std::vector<Attribute>;

/// Of `name`, or null.
const Attribute* find(const Attributes& attributes, std::string_view name);

/// A rectangle from the lower left corner: in fractions of what it is part of, or, of windows,
/// channels and pipes, in pixels where it is wider or higher than 1.
struct Viewport {
    double x = 0;
    double y = 0;
    double width = 1;
    double height = 1;

    bool isPixels() const { return width > 1 || height > 1; }
    bool operator==(const Viewport&) const = default;
};

/// A plane in space on which a picture is seen, by three of its corners.
struct Wall {
    fabric::Vec3 bottomLeft{-.8, -.5, -1};
    fabric::Vec3 bottomRight{.8, -.5, -1};
    fabric::Vec3 topLeft{-.8, .5, -1};
    bool movesWithHead = false;  ///< a head-mounted display

    bool operator==(const Wall&) const = default;
};

/// A projector: another way to write a wall.
struct Projection {
    fabric::Vec3 origin{0, 0, 0};
    double distance = 1;
    fabric::Vec2 fovDegrees{77.3196, 53.1301};  ///< horizontal, vertical
    fabric::Vec3 headingPitchRollDegrees{0, 0, 0};

    bool operator==(const Projection&) const = default;
};

using Surface = std::variant<std::monostate, Wall, Projection>;

struct SwapBarrier {
    std::string name;
    Attributes attributes;  ///< NV_group, NV_barrier

    bool operator==(const SwapBarrier&) const = default;
};

struct Connection {
    std::string type;  ///< TCPIP and others, which count as TCPIP here; empty: TCPIP
    std::string hostname;
    std::string interfaceName;
    std::int64_t port = 0;
    std::int64_t bandwidth = 0;
    std::string filename;

    bool operator==(const Connection&) const = default;
};

struct Channel {
    std::string name;
    std::optional<Viewport> viewport;    ///< in its window
    std::vector<std::string> drawables;  ///< FBO_COLOR, FBO_DEPTH, FBO_STENCIL
    Attributes attributes;
    Place place;

    bool operator==(const Channel&) const = default;
};

struct Window {
    std::string name;
    std::optional<Viewport> viewport;  ///< in its pipe
    Attributes attributes;
    std::vector<Channel> channels;
    Place place;

    bool operator==(const Window&) const = default;
};

struct Pipe {
    std::string name;
    std::optional<std::int64_t> port;
    std::optional<std::int64_t> device;
    std::optional<Viewport> viewport;  ///< pixels
    Attributes attributes;
    std::vector<Window> windows;
    Place place;

    bool operator==(const Pipe&) const = default;
};

struct Node {
    std::string name;
    bool isApplication = false;  ///< it also shows the pictures
    std::string host;
    std::vector<Connection> connections;
    Attributes attributes;
    std::vector<Pipe> pipes;
    Place place;

    bool operator==(const Node&) const = default;
};

enum class FocusMode { Fixed, RelativeToOrigin, RelativeToObserver };

struct Observer {
    std::string name;
    std::optional<double> eyeBase;  ///< metres between the eyes
    std::optional<fabric::Vec3> eyeLeft;
    std::optional<fabric::Vec3> eyeCyclop;
    std::optional<fabric::Vec3> eyeRight;
    double focusDistance = 1;
    FocusMode focusMode = FocusMode::Fixed;
    std::string openCvCamera;
    std::string vrpnTracker;
    Place place;

    bool operator==(const Observer&) const = default;
};

enum class StereoMode { Auto, Quad, Anaglyph, Passive };

struct View {
    std::string name;
    bool isStereo = false;
    Viewport viewport;  ///< of the layout
    Surface surface;
    std::optional<std::size_t> observer;
    /// How two eyes are shown in one picture, before what compounds say. In no file; see state.h.
    std::optional<StereoMode> stereoMode;
    Attributes attributes;
    Place place;

    bool operator==(const View&) const = default;
};

struct Layout {
    std::string name;
    std::vector<View> views;
    Place place;

    bool operator==(const Layout&) const = default;
};

/// A set of eyes.
struct Eyes {
    bool cyclop = false;
    bool left = false;
    bool right = false;

    bool isEmpty() const { return !cyclop && !left && !right; }
    bool operator==(const Eyes&) const = default;
};

/// A channel of a node, by position.
struct ChannelIndex {
    std::size_t node = 0;
    std::size_t pipe = 0;
    std::size_t window = 0;
    std::size_t channel = 0;

    bool operator==(const ChannelIndex&) const = default;
};

struct Segment {
    std::string name;
    std::optional<ChannelIndex> channel;
    Viewport viewport;  ///< of the canvas
    Eyes eyes{true, true, true};
    Surface surface;
    std::optional<SwapBarrier> swapBarrier;
    Place place;

    bool operator==(const Segment&) const = default;
};

struct Canvas {
    std::string name;
    std::vector<std::optional<std::size_t>> layouts;  ///< none: off
    Surface surface;
    std::optional<SwapBarrier> swapBarrier;
    std::vector<Segment> segments;
    Place place;

    bool operator==(const Canvas&) const = default;
};

/// A view where it falls on a segment: what is shown there is drawn by its destination channel.
struct DestinationIndex {
    std::size_t canvas = 0;
    std::size_t segment = 0;
    std::size_t layout = 0;
    std::size_t view = 0;

    bool operator==(const DestinationIndex&) const = default;
};

using ChannelReference = std::variant<std::monostate, ChannelIndex, DestinationIndex>;

struct Tasks {
    bool clear = false;
    bool draw = false;
    bool assemble = false;
    bool readback = false;

    bool operator==(const Tasks&) const = default;
};

struct Buffers {
    bool colour = false;
    bool depth = false;

    bool operator==(const Buffers&) const = default;
};

/// Every width-th column from x on and every height-th row from y on.
struct PixelShare {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t width = 1;
    std::int64_t height = 1;

    bool operator==(const PixelShare&) const = default;
};

struct SubPixelShare {
    std::int64_t index = 0;
    std::int64_t count = 1;

    bool operator==(const SubPixelShare&) const = default;
};

/// An output or input frame: a picture that passes between compounds, by name.
struct Frame {
    /// Empty: "frame." and that of the compound or else of its channel, which it may inherit.
    std::string name;
    bool isTexture = false;
    /// Output: what of the compound's picture it is. Input: its lower left corner is where the
    /// picture that the frame is a part of begins, and nothing comes in beside it.
    Viewport viewport;
    std::optional<Buffers> buffers;
    /// Output: its pixels for each pixel there is; nothing: as many. Input: pixels for each of the
    /// frame's; nothing: as many as make it fit.
    std::optional<fabric::Vec2> zoom;
    Place place;

    bool operator==(const Frame&) const = default;
};

/// A queue of tiles or, with `chunk`, of ranges.
struct Tiles {
    std::string name;
    std::optional<fabric::Vec2> size;  ///< whole pixels
    std::optional<double> chunk;       ///< share of the range
    Place place;

    bool operator==(const Tiles&) const = default;
};

enum class EqualizerKind { Load, Tree, Dfr, Tile, View, Monitor, Framerate };
enum class SplitMode { TwoD, Db, Horizontal, Vertical };

struct Equalizer {
    EqualizerKind kind = EqualizerKind::Load;
    std::string name;
    SplitMode mode = SplitMode::TwoD;
    double damping = .5;
    /// In pixels (two numbers) or as a share of the range (one).
    std::optional<fabric::Vec2> boundaryPixels;
    std::optional<double> boundaryRange;
    std::optional<fabric::Vec2> resistancePixels;
    std::optional<double> resistanceRange;
    std::optional<double> assembleOnlyLimit;
    double framerate = 10;
    fabric::Vec2 tileSize{64, 64};
    std::optional<double> tileChunk;
    Place place;

    bool operator==(const Equalizer&) const = default;
};

struct ColourMask {
    bool red = false;
    bool green = false;
    bool blue = false;

    bool operator==(const ColourMask&) const = default;
};

struct Compound {
    std::string name;
    ChannelReference channel;
    std::optional<Tasks> tasks;
    std::optional<Buffers> buffers;
    std::optional<Eyes> eyes;
    Viewport viewport;
    fabric::Range range;
    std::optional<std::int64_t> period;
    std::optional<std::int64_t> phase;
    PixelShare pixel;
    SubPixelShare subpixel;
    fabric::Vec2 zoom{1, 1};
    Surface surface;
    std::optional<SwapBarrier> swapBarrier;
    std::optional<StereoMode> stereoMode;
    std::optional<ColourMask> anaglyphLeft;
    std::optional<ColourMask> anaglyphRight;
    std::vector<Frame> outputFrames;
    std::vector<Frame> inputFrames;
    std::vector<Tiles> outputTiles;
    std::vector<Tiles> inputTiles;
    std::vector<Equalizer> equalizers;
    std::vector<Compound> children;
    Place place;

    bool operator==(const Compound&) const = default;
};

/// Whether the compound, or one within it, draws what a view shows on a segment.
inline bool namesDestination(const Compound& compound) {
    return std::holds_alternative<DestinationIndex>(compound.channel) ||
           std::ranges::any_of(compound.children, namesDestination);
}

struct Configuration {
    std::string version;  ///< of the file's form; of text empty: before 1.0
    Attributes globals;   ///< by their whole names, such as EQ_WINDOW_IATTR_HINT_STEREO
    std::string name;
    std::int64_t latency = 1;
    Attributes attributes;                ///< eye_base, robustness
    std::vector<Connection> connections;  ///< of the server
    std::vector<Node> nodes;
    std::vector<Observer> observers;
    std::vector<Layout> layouts;
    std::vector<Canvas> canvases;
    std::vector<Compound> compounds;

    bool operator==(const Configuration&) const = default;
};

}  // namespace eyrie::config
