// SPDX-License-Identifier: Apache-2.0
// bench/soak for 20 seconds, and that it sees what it looks for. By hand it runs for hours.
#include <chrono>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bench/process_figures.h"
#include "tests/support/process.h"
#include "tests/support/program.h"

namespace eyrie {
namespace {

using bench::ProcessFigures;

TEST(Soak, PicturesDescriptorsAndThreadsStayWhileRenderersAreKilled) {
    // Seconds, a kill every 5 of them, 3 renderers.
    const test::Outcome outcome =
        test::run({EYRIE_SOAK_BINARY, EYRIE_BINARY, EYRIE_SOURCE_DIR "/demo/scene.json", "20", "5",
                   "3", "160x90"},
                  std::chrono::seconds(280));
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.output << outcome.errors;
    fmt::print("{}", outcome.output);
}

TEST(ProcessFigures, CountADescriptorThatIsOpened) {
    const auto before = bench::figuresOf(getpid(), 0);
    const int opened = open("/dev/null", O_RDONLY | O_CLOEXEC);
    const auto after = bench::figuresOf(getpid(), 1);
    close(opened);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(after->descriptors, before->descriptors + 1);
    EXPECT_GT(after->residentMebibytes, 1);
    EXPECT_FALSE(bench::figuresOf(-1, 0));
}

TEST(ProcessFigures, GrowthIsWhatStaysAndNotWhatPasses) {
    const std::vector<ProcessFigures> passing{
        {0, 0, 10, 4}, {1, 0, 14, 4}, {2, 0, 13, 4}, {3, 0, 10, 5}};
    EXPECT_EQ(bench::growthOf(&ProcessFigures::descriptors, passing), 0);
    const std::vector<ProcessFigures> leaking{
        {0, 0, 10, 4}, {1, 0, 11, 4}, {2, 0, 12, 4}, {3, 0, 13, 4}};
    EXPECT_EQ(bench::growthOf(&ProcessFigures::descriptors, leaking), 2);
    EXPECT_EQ(bench::growthOf(&ProcessFigures::threads, leaking), 0);
}

TEST(ProcessFigures, SlopeIsThatOfALine) {
    const std::vector<ProcessFigures> line{{0, 100, 0, 0}, {1800, 101, 0, 0}, {3600, 102, 0, 0}};
    EXPECT_NEAR(bench::residentSlope(line), 2, 1e-9);
    EXPECT_EQ(bench::residentSlope({}), 0);
}

}  // namespace
}  // namespace eyrie
