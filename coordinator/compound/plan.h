// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/config/configuration.h"
#include "coordinator/config/display.h"
#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"
#include "fabric/channel_task.h"
#include "fabric/regridding.h"
#include "fabric/seen_area.h"

/// A frame of a configuration as a list: what is drawn, and what is done with it until the pictures
/// are there. After Eilemann, Makhinya, Pajarola: "Equalizer: A Scalable Parallel Rendering
/// Framework" (2009): compounds clear, draw, assemble and read back.
namespace eyrie::compound {

using Eye = config::EyeSight::Eye;

/// How the pictures of two eyes are shown.
enum class Stereo {
    Configured,  ///< as the compound says; by default as an anaglyph where one channel shows both
    Anaglyph,    ///< one picture, whose colours are the left's and the right's
    SideBySide,  ///< one picture of twice the width, the left eye's at the left
    TopBottom,   ///< one picture of twice the height, the left eye's above
    Separate     ///< two pictures
};

/// A picture that is asked for.
struct Output {
    std::size_t canvas = 0;
    std::optional<std::size_t> segment;     ///< nothing: the whole canvas
    std::optional<config::PixelSize> size;  ///< of that; nothing: as configured
    /// The part that is wanted, in pixels of one eye's picture; nothing: all of it.
    std::optional<fabric::PixelViewport> part;
    std::optional<Eye> eye;  ///< only what this eye sees; nothing: what the view shows
    Stereo stereo = Stereo::Configured;
    bool wantsDepth = false;  ///< not of anaglyphs
};

struct PlanRequest {
    std::vector<Output> outputs;
    std::uint64_t frameNumber = 0;
    /// Layouts, heads and the model unit; sizes are taken from the outputs. Where a canvas and its
    /// segments are asked for, the canvas's size counts.
    config::Display display;
    double fovYDegrees = 45;  ///< the camera's, for two eyes where there is no wall
    bool looksForGaps = false;
};

/// A picture in the making: all that one channel does for one eye of one destination, in one
/// raster.
struct Framebuffer {
    config::ChannelIndex channel;  ///< that would do it
    /// Its destination's own: here the picture is put together, and the coordinator needs it.
    bool isDestination = false;
    Eye eye = Eye::Cyclop;
    fabric::PixelViewport area;  ///< in pixels of the tasks that draw to it

    bool operator==(const Framebuffer&) const = default;
};

/// How a picture comes over what is there.
enum class Combine {
    Over,           ///< nothing is there
    Replace,        ///< its rectangle is overwritten, background too
    Nearer,         ///< by depth; of equally near pixels that stays which was there
    NearerOrEqual,  ///< by depth; of equally near pixels that comes which is new
};

struct Clear {
    std::size_t framebuffer = 0;
    fabric::PixelViewport part;

    bool operator==(const Clear&) const = default;
};

struct Draw {
    std::size_t framebuffer = 0;
    std::size_t draw = 0;  ///< in Plan::draws
    Combine combine = Combine::Over;

    bool operator==(const Draw&) const = default;
};

/// A part of a framebuffer becomes an output frame.
struct ReadBack {
    std::size_t framebuffer = 0;
    std::size_t frame = 0;
    fabric::PixelViewport part;
    bool withDepth = false;
    std::optional<fabric::Regridding> zoom;  ///< of `part`

    bool operator==(const ReadBack&) const = default;
};

/// An input frame is brought into a framebuffer.
struct Assemble {
    std::size_t frame = 0;
    std::size_t framebuffer = 0;
    fabric::PixelViewport part;  ///< what the frame covers, in its own pixels
    /// From the framebuffer's pixels to the frame's, whose pixels then count from (fromX, fromY).
    std::vector<fabric::Regridding> regriddings;
    std::int32_t fromX = 0;
    std::int32_t fromY = 0;
    Combine combine = Combine::Over;
    /// Of the framebuffer, beside which nothing comes; nothing: all that there is.
    std::optional<fabric::PixelViewport> within = {};

    bool operator==(const Assemble&) const = default;
};

/// Each pixel becomes the mean of its samples, rounded to the nearest; depth is the first's.
struct Average {
    std::vector<std::size_t> samples;  ///< framebuffers
    std::size_t framebuffer = 0;
    fabric::PixelViewport part;
    Combine combine = Combine::Over;

    bool operator==(const Average&) const = default;
};

using Step = std::variant<Clear, Draw, ReadBack, Assemble, Average>;

/// A task for a renderer. Its frameDataVersion is left for who sends it.
struct PlannedDraw {
    config::ChannelIndex channel;
    std::size_t compound = 0;  ///< in ResolvedConfiguration::compounds
    fabric::ChannelTask task;
    std::size_t framebuffer = 0;
    /// In Plan::queues: any of those channels may draw it. Nothing: `channel` is to.
    std::optional<std::size_t> queue = {};
};

/// Where a framebuffer is in a picture.
struct PicturePart {
    std::size_t framebuffer = 0;
    fabric::PixelViewport part;  ///< in the framebuffer's pixels
    std::int32_t x = 0;          ///< of its lower left corner in the picture
    std::int32_t y = 0;
};

struct Picture {
    std::size_t output = 0;   ///< in PlanRequest::outputs
    std::optional<Eye> eye;   ///< whose, if one eye's alone
    config::PixelSize whole;  ///< of one eye's whole picture, of which `area` is a part
    fabric::PixelViewport area;
    bool withDepth = false;
    Stereo stereo = Stereo::Separate;  ///< how two eyes are put together; Separate: one eye
    std::vector<PicturePart> parts;    ///< of that eye, or the left; later ones lie above
    std::vector<PicturePart> right;    ///< empty where there is one eye
    /// Why a part of it shows nothing, for a person to read; empty where all does.
    std::string whyBlind;
    /// By which sights it is seen. Of two eyes in the same place, the left one's.
    fabric::SeenAreas seen;
    config::ColourMask leftMask{true, false, false};
    config::ColourMask rightMask{false, true, true};
};

/// A frame without depth that has a part of the data only: it comes over all that others have
/// drawn, also over what is nearer.
struct LostDepth {
    const config::Compound* compound = nullptr;  ///< of the configuration, that makes it
    /// One of its output frames; null: what it draws in other pixels than the compound above it.
    const config::Frame* frame = nullptr;
};

struct Plan {
    std::vector<PlannedDraw> draws;
    std::vector<Framebuffer> framebuffers;
    std::size_t frames = 0;
    std::vector<Step> steps;  ///< each after those that it depends on
    std::vector<Picture> pictures;
    /// Channels that take tiles or chunks of one queue, each when it is free.
    std::vector<std::vector<config::ChannelIndex>> queues;
    /// Parts of pictures that show nothing, since an eye is not before the wall there, or sees
    /// through it what renderers cannot draw.
    std::size_t blind = 0;
    /// Of PlanRequest::looksForGaps: warnings of parts of pictures that nobody draws.
    config::Findings gaps;
    /// Of PlanRequest::looksForGaps.
    std::vector<LostDepth> lostDepth;
};

/// What is on display when that is asked for: what the request says, in the sizes of its outputs,
/// whose canvases are there.
config::Display displayOf(const config::Configuration& configuration, const PlanRequest& request);

/// Why there is no plan: errors, each where it is in the configuration.
struct Refusals {
    config::Findings impossible;  ///< in any size, or asked for what is not there
    config::Findings tooLarge;    ///< pictures that renderers draw where a smaller one is asked for
};

/// Only what the outputs need: no depth that nothing compares, nothing that nobody sees. Nothing,
/// and all that is wrong, where the configuration has errors, a canvas or segment is not there, a
/// picture is larger than renderers draw, nothing of an output is shown to an eye, or frames wait
/// for each other.
std::optional<Plan> makePlan(const config::Configuration& configuration, const PlanRequest& request,
                             Refusals& refusals);

/// InvalidArgument: the first of the refusals, with its place where the size is not to blame.
absl::StatusOr<Plan> makePlan(const config::Configuration& configuration,
                              const PlanRequest& request);

}  // namespace eyrie::compound
