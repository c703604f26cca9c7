// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/problem.h"

#include <gmock/gmock.h>

#include "coordinator/frame/frame_source.h"

namespace eyrie::coordinator {
namespace {

TEST(Problem, WithoutARendererItSaysHowToStartOne) {
    EXPECT_THAT(problemOf({0, 0, false, "", "eyrie renderer --coordinator h:9"}),
                testing::HasSubstr("`eyrie renderer --coordinator h:9`"));
}

TEST(Problem, NobodyIsToldToStartOneWhereTheyStartByThemselves) {
    const std::string problem = problemOf({0, 0, false, "", ""});
    EXPECT_THAT(problem, testing::HasSubstr("starts those again that end"));
    EXPECT_THAT(problem, testing::Not(testing::HasSubstr("eyrie renderer")));
}

TEST(Problem, AnEmptySceneIsNamed) {
    EXPECT_THAT(problemOf({2, 0, true, "", ""}), testing::HasSubstr("scene is empty"));
}

TEST(Problem, OpeningIsSaidUntilOneRendererIsReady) {
    EXPECT_THAT(problemOf({0, 1, false, "", ""}), testing::HasSubstr("opening the scene"));
    EXPECT_EQ(problemOf({1, 1, false, "", ""}), "");
}

TEST(Problem, WhatTheRendererSaidIsPassedOn) {
    EXPECT_THAT(problemOf({0, 0, false, "/d/a.eyt: no such file", ""}),
                testing::HasSubstr("/d/a.eyt: no such file"));
    EXPECT_EQ(problemOf({1, 0, false, "/d/a.eyt: no such file", ""}), "");
}

TEST(Note, CountsTheRenderersThatAreMissing) {
    EXPECT_THAT(noteOf(3, 4), testing::StartsWith("3 of the 4 renderers"));
    EXPECT_EQ(noteOf(4, 4), "");
    EXPECT_EQ(noteOf(5, 4), "");
}

TEST(Note, SaysThatASceneIsTooSmallToBeSeenWhole) {
    const fabric::Box small{{10, 0, 0}, {10.0003, 0.0004, 0}};
    EXPECT_THAT(noteOfSize(small), testing::StartsWith("the scene is 0.5 mm across"));
    EXPECT_EQ(noteOfSize({{0, 0, 0}, {.003, 0, 0}}), "");
    EXPECT_EQ(noteOfSize({{1, 1, 1}, {1, 1, 1}}), "") << "a point is no matter of scale";
    EXPECT_EQ(noteOfSize({}), "");
}

TEST(Note, AFrameOfWhichAPartShowsNothingIsNoEmptyOne) {
    RenderedFrame frame;
    frame.pictures = {{0, std::vector<fabric::SeenArea>()}, {0, std::nullopt}};
    EXPECT_EQ(whyPartlyEmpty(frame), "");
    frame.pictures[0].whyBlind = "the eye is not before the wall";
    EXPECT_THAT(whyPartlyEmpty(frame), testing::HasSubstr("not before the wall"));
    EXPECT_EQ(whyEmpty(frame), "");
}

TEST(Note, ACanvasOfOthersFramesIsNoEmptyOne) {
    RenderedFrame monitor;
    monitor.pictures = {{0, std::vector<fabric::SeenArea>()}};
    EXPECT_THAT(whyEmpty(monitor), testing::HasSubstr("Nothing is seen here"));
    EXPECT_THAT(whyEmpty(monitor), testing::HasSubstr("no compound draws"));
    monitor.parts.emplace_back();
    EXPECT_EQ(whyEmpty(monitor), "");
}

}  // namespace
}  // namespace eyrie::coordinator
