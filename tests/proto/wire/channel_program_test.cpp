// SPDX-License-Identifier: Apache-2.0
#include "wire/channel_program.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "eyrie/v1/channel_program.pb.h"
#include "eyrie/v1/frame.pb.h"

namespace eyrie::wire {
namespace {

using fabric::ChannelProgram;
using fabric::Merge;

fabric::ProgramStage anyStage(std::uint32_t& frame) {
    fabric::ProgramStage stage;
    if (*rc::gen::arbitrary<bool>())
        stage.draw = fabric::ChannelTask{7, 8, 100, 60, {10, 5, 20, 10}, {0.25, 0.5}, true};
    for (int left = *rc::gen::inRange(0, 4); left > 0; --left)
        stage.inputs.push_back(
            {frame++,
             {*rc::gen::inRange(10, 20), 6, 5, 4},
             *rc::gen::element(Merge::Paste, Merge::DepthBehind, Merge::DepthBefore)});
    for (int left = *rc::gen::inRange(0, 4); left > 0; --left)
        stage.outputs.push_back({frame++,
                                 {11, *rc::gen::inRange(5, 9), 3, 2},
                                 *rc::gen::arbitrary<bool>(),
                                 *rc::gen::element<std::string>("", "unix:/run/r0", "node7:4711")});
    return stage;
}

ChannelProgram anyProgram() {
    ChannelProgram program{
        *rc::gen::inRange<std::uint64_t>(1, 1U << 30), 5, {10, 5, 30, 20}, true, {1, 2, 3, 4}, {}};
    std::uint32_t frame = 0;
    for (int left = *rc::gen::inRange(1, 4); left > 0; --left)
        program.stages.push_back(anyStage(frame));
    return program;
}

RC_GTEST_PROP(WireChannelProgram, ComesBackAsItWas, ()) {
    const ChannelProgram program = anyProgram();
    RC_ASSERT(*fromMessage(toMessage(program)) == program);
}

ChannelProgram sample() {
    return {77, 5, {10, 5, 30, 20}, true, {}, {{{}, {{1, {10, 5, 3, 3}, Merge::DepthBehind}}, {}}}};
}

std::string refusal(const ChannelProgram& program) {
    const absl::Status status = fromMessage(toMessage(program)).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status));
    return std::string(status.message());
}

TEST(WireChannelProgram, WhatItMustNotHoldIsRefusedByField) {
    using testing::HasSubstr;
    ASSERT_TRUE(fromMessage(toMessage(sample())).ok());
    ChannelProgram program = sample();
    program.session = 0;
    EXPECT_THAT(refusal(program), HasSubstr("program.session is 0"));
    program = sample();
    program.stages.clear();
    EXPECT_THAT(refusal(program), HasSubstr("0 stages in program"));
    program = sample();
    program.stages[0].inputs[0].area.x = 9;
    EXPECT_THAT(refusal(program), HasSubstr("program.stages[0]: area is 3x3 at 9,5"));
    program = sample();
    program.stages.push_back(program.stages[0]);
    EXPECT_THAT(refusal(program), HasSubstr("program.stages[1]: frame 1 is an input"));
    program = sample();
    program.hasDepth = false;
    EXPECT_THAT(refusal(program), HasSubstr("a merge by depth needs depth"));
    program = sample();
    program.stages[0].outputs.push_back({2, {10, 5, 3, 3}, false, "nowhere"});
    EXPECT_THAT(refusal(program), HasSubstr("nowhere"));
    program = sample();
    program.stages[0].outputs.assign(fabric::kMaxStageFrames + 1, {2, {10, 5, 3, 3}, false, ""});
    EXPECT_THAT(refusal(program), HasSubstr("257 outputs"));
    program = sample();
    program.area = {0, 0, fabric::kMaxViewPixels, fabric::kMaxViewPixels};
    program.stages[0].outputs = {{2, program.area, false, ""}, {3, program.area, false, "node7:1"}};
    EXPECT_TRUE(fromMessage(toMessage(program)).ok());
    program.stages[0].outputs.push_back({4, {10, 5, 1, 1}, false, ""});
    EXPECT_THAT(refusal(program), HasSubstr("more than 268435456 pixels"));
    program = sample();
    program.stages[0].draw = fabric::ChannelTask{7, 8, 100, 60, {0, 0, 20, 10}, {}, true};
    EXPECT_THAT(refusal(program), HasSubstr("draw.pixel_viewport"));
}

TEST(WireChannelProgram, AnUnknownMergeIsRefused) {
    v1::ChannelProgram message = toMessage(sample());
    message.mutable_stages(0)->mutable_inputs(0)->set_merge(static_cast<v1::ProgramMerge>(9));
    EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status()));
}

}  // namespace
}  // namespace eyrie::wire
