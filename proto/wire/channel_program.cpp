// SPDX-License-Identifier: Apache-2.0
#include "wire/channel_program.h"

#include <bit>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "eyrie/v1/channel_program.pb.h"
#include "eyrie/v1/frame.pb.h"
#include "fabric/status.h"
#include "wire/frame.h"
#include "wire/listen.h"

namespace eyrie::wire {
namespace {

v1::ProgramMerge mergeMessage(fabric::Merge merge) {
    switch (merge) {
        case fabric::Merge::Paste:
            return v1::PROGRAM_MERGE_PASTE;
        case fabric::Merge::DepthBehind:
            return v1::PROGRAM_MERGE_DEPTH_BEHIND;
        case fabric::Merge::DepthBefore:
            return v1::PROGRAM_MERGE_DEPTH_BEFORE;
    }
    return v1::PROGRAM_MERGE_UNSPECIFIED;
}

absl::StatusOr<fabric::Merge> mergeFrom(v1::ProgramMerge merge) {
    switch (merge) {
        case v1::PROGRAM_MERGE_UNSPECIFIED:
        case v1::PROGRAM_MERGE_PASTE:
            return fabric::Merge::Paste;
        case v1::PROGRAM_MERGE_DEPTH_BEHIND:
            return fabric::Merge::DepthBehind;
        case v1::PROGRAM_MERGE_DEPTH_BEFORE:
            return fabric::Merge::DepthBefore;
        default:
            return absl::InvalidArgumentError(fmt::format(
                "merge is {}, which this version does not know", static_cast<int>(merge)));
    }
}

absl::Status checkCount(std::string_view what, int count, std::size_t least, std::size_t most) {
    if (std::cmp_greater_equal(count, least) && std::cmp_less_equal(count, most))
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("there are {} {}; it must be {} to {}", count, what, least, most));
}

/// Of all that a program answers with: the renderer holds it until it is sent.
constexpr std::int64_t kMostAnswerPixels =
    std::int64_t{fabric::kMaxViewPixels} * fabric::kMaxViewPixels;

/// What a program's parts are checked against.
struct Bounds {
    fabric::PixelViewport area;
    bool hasDepth = false;
    std::set<std::uint32_t> announced;
    std::int64_t answerPixels = 0;  ///< so far
};

absl::StatusOr<fabric::PixelViewport> areaWithin(const v1::PixelViewport& message,
                                                 const Bounds& bounds) {
    ASSIGN_OR_RETURN(const fabric::PixelViewport area, fromMessage(message));
    const fabric::PixelViewport& whole = bounds.area;
    if (area.isEmpty() || !whole.contains(area))
        return absl::InvalidArgumentError(fmt::format(
            "area is {}x{} at {},{}; it must not be empty and lie inside the program's {}x{} at "
            "{},{}",
            area.width, area.height, area.x, area.y, whole.width, whole.height, whole.x, whole.y));
    return area;
}

absl::Status needsDepth(std::string_view what, const Bounds& bounds) {
    if (bounds.hasDepth)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("{} needs depth, which the program's framebuffer does not have", what));
}

absl::StatusOr<fabric::ChannelTask> readDraw(const v1::ChannelTask& message, const Bounds& bounds) {
    ASSIGN_OR_RETURN(fabric::ChannelTask task, fromMessage(message));
    if (!bounds.area.contains(task.pixelViewport))
        return absl::InvalidArgumentError("draw.pixel_viewport must lie inside the program's area");
    return task;
}

absl::StatusOr<fabric::ProgramInput> readInput(const v1::ProgramInput& message, Bounds& bounds) {
    fabric::ProgramInput input;
    input.frame = message.frame();
    if (!bounds.announced.insert(input.frame).second)
        return absl::InvalidArgumentError(
            fmt::format("frame {} is an input of this program already", input.frame));
    ASSIGN_OR_RETURN(input.area, areaWithin(message.area(), bounds));
    ASSIGN_OR_RETURN(input.merge, mergeFrom(message.merge()));
    if (input.merge != fabric::Merge::Paste)
        RETURN_IF_ERROR(needsDepth("a merge by depth", bounds));
    return input;
}

absl::StatusOr<fabric::ProgramOutput> readOutput(const v1::ProgramOutput& message, Bounds& bounds) {
    fabric::ProgramOutput output;
    output.frame = message.frame();
    ASSIGN_OR_RETURN(output.area, areaWithin(message.area(), bounds));
    output.withDepth = message.with_depth();
    if (output.withDepth)
        RETURN_IF_ERROR(needsDepth("with_depth", bounds));
    output.to = message.to();
    if (!output.to.empty()) {
        RETURN_IF_ERROR(checkAddress(output.to));
        return output;
    }
    bounds.answerPixels += output.area.area();
    if (bounds.answerPixels > kMostAnswerPixels)
        return absl::InvalidArgumentError(
            fmt::format("outputs without an address, which are the answer, have more than {} "
                        "pixels",
                        kMostAnswerPixels));
    return output;
}

absl::StatusOr<fabric::ProgramStage> readStage(const v1::ProgramStage& message, Bounds& bounds) {
    RETURN_IF_ERROR(checkCount("inputs", message.inputs_size(), 0, fabric::kMaxStageFrames));
    RETURN_IF_ERROR(checkCount("outputs", message.outputs_size(), 0, fabric::kMaxStageFrames));
    fabric::ProgramStage stage;
    if (message.has_draw()) {
        ASSIGN_OR_RETURN(stage.draw, readDraw(message.draw(), bounds));
    }
    for (const v1::ProgramInput& input : message.inputs()) {
        ASSIGN_OR_RETURN(stage.inputs.emplace_back(), readInput(input, bounds));
    }
    for (const v1::ProgramOutput& output : message.outputs()) {
        ASSIGN_OR_RETURN(stage.outputs.emplace_back(), readOutput(output, bounds));
    }
    return stage;
}

}  // namespace

v1::ChannelProgram toMessage(const fabric::ChannelProgram& program) {
    v1::ChannelProgram message;
    message.set_session(program.session);
    message.set_frame_number(program.frameNumber);
    *message.mutable_area() = toMessage(program.area);
    message.set_has_depth(program.hasDepth);
    message.set_background(std::bit_cast<std::uint32_t>(program.background));
    for (const fabric::ProgramStage& stage : program.stages) {
        v1::ProgramStage& to = *message.add_stages();
        if (stage.draw)
            *to.mutable_draw() = toMessage(*stage.draw);
        for (const fabric::ProgramInput& input : stage.inputs) {
            v1::ProgramInput& put = *to.add_inputs();
            put.set_frame(input.frame);
            *put.mutable_area() = toMessage(input.area);
            put.set_merge(mergeMessage(input.merge));
        }
        for (const fabric::ProgramOutput& output : stage.outputs) {
            v1::ProgramOutput& put = *to.add_outputs();
            put.set_frame(output.frame);
            *put.mutable_area() = toMessage(output.area);
            put.set_with_depth(output.withDepth);
            put.set_to(output.to);
        }
    }
    return message;
}

absl::StatusOr<fabric::ChannelProgram> fromMessage(const v1::ChannelProgram& message) {
    fabric::ChannelProgram program;
    program.session = message.session();
    if (program.session == 0)
        return absl::InvalidArgumentError("program.session is 0; it must be chosen at random");
    program.frameNumber = message.frame_number();
    ASSIGN_OR_RETURN(program.area, fromMessage(message.area()));
    program.hasDepth = message.has_depth();
    program.background = std::bit_cast<fabric::Rgba>(message.background());
    RETURN_IF_ERROR(
        checkCount("stages in program", message.stages_size(), 1, fabric::kMaxProgramStages));
    Bounds bounds{program.area, program.hasDepth, {}, 0};
    for (int i = 0; i < message.stages_size(); ++i) {
        absl::StatusOr<fabric::ProgramStage> stage = readStage(message.stages(i), bounds);
        if (!stage.ok())
            return fabric::withContext(stage.status(), fmt::format("program.stages[{}]", i));
        program.stages.push_back(*std::move(stage));
    }
    return program;
}

}  // namespace eyrie::wire
