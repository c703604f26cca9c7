// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fabric/channel_task.h"
#include "fabric/image.h"
#include "fabric/statistics.h"
#include "fabric/viewport.h"

namespace eyrie::fabric {

/// A renderer runs as many at a time, and refuses more.
inline constexpr std::size_t kMaxPrograms = 16;

/// How a picture joins what a framebuffer holds.
enum class Merge {
    Paste,        ///< in place of it
    DepthBehind,  ///< the nearer pixel stays; of equally near ones that of the framebuffer
    DepthBefore,  ///< the nearer pixel stays; of equally near ones that of the picture
};

/// A picture that another renderer sends.
struct ProgramInput {
    std::uint32_t frame = 0;  ///< as its sender calls it; no two inputs of a program have the same
    PixelViewport area;       ///< what is sent lies within it; the rest of it is background
    Merge merge = Merge::Paste;

    bool operator==(const ProgramInput&) const = default;
};

/// A part of the framebuffer that is sent on.
struct ProgramOutput {
    std::uint32_t frame = 0;
    PixelViewport area;
    bool withDepth = false;
    std::string to;  ///< address of a renderer; empty: it goes into the answer

    bool operator==(const ProgramOutput&) const = default;
};

/// First the draw, by DepthBehind where both the framebuffer and the task have depth and else
/// pasted; then the inputs, in this order whenever they arrive; then the outputs.
struct ProgramStage {
    std::optional<ChannelTask> draw;
    std::vector<ProgramInput> inputs;
    std::vector<ProgramOutput> outputs;

    bool operator==(const ProgramStage&) const = default;
};

/// What one renderer does for one channel in one frame: stages over one framebuffer, which begins
/// as background with depth 0. Direct-send and binary swap are programs that name each other's
/// frames; an output's number and an input's are the same picture.
///
/// Sort-last programs give the picture of a central merge, ties included, where each input is
/// adjacent in range to what the framebuffer holds by then: DepthBefore for the range before it,
/// DepthBehind for the one after.
struct ChannelProgram {
    /// Random, of one coordinator and scene; not 0. Together with the frame's number it keeps apart
    /// what is in flight: a renderer takes no picture of another.
    std::uint64_t session = 0;
    std::uint64_t frameNumber = 0;
    PixelViewport area;  ///< of the framebuffer, in a picture's pixels; contains all below
    bool hasDepth = false;
    Rgba background;  ///< of what nothing was drawn on, in every picture of the frame
    std::vector<ProgramStage> stages;  ///< 1 to kMaxProgramStages

    bool operator==(const ChannelProgram&) const = default;
};

inline constexpr std::size_t kMaxProgramStages = 64;
inline constexpr std::size_t kMaxStageFrames = 256;  ///< inputs, or outputs

/// What came of a program for the caller: one picture for each output without an address, in their
/// order, its area the covered part of the output's; and the statistics of each draw.
struct ProgramPicture {
    std::uint32_t frame = 0;
    Image image;
};
struct ProgramResult {
    std::vector<ProgramPicture> pictures;
    std::vector<FrameStatistics> draws;
};

}  // namespace eyrie::fabric
