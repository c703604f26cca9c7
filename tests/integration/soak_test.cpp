// SPDX-License-Identifier: Apache-2.0
// bench/soak for 20 seconds, and that it sees what it looks for. By hand it runs for hours.
#include <chrono>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
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
    const int memory = memfd_create("picture", MFD_CLOEXEC);
    const auto after = bench::figuresOf(getpid(), 1);
    close(opened);
    close(memory);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(after->descriptors, before->descriptors + 1);
    EXPECT_EQ(after->memoryFiles, before->memoryFiles + 1);
    EXPECT_GT(after->residentMebibytes, 1);
    EXPECT_FALSE(bench::figuresOf(-1, 0));
}

TEST(ProcessFigures, GrowthIsWhatStaysAndNotWhatPasses) {
    const auto growth = [](const std::vector<int>& descriptors) {
        std::vector<ProcessFigures> samples;
        for (const int held : descriptors) samples.push_back({.descriptors = held});
        EXPECT_EQ(bench::growthOf(&ProcessFigures::threads, samples), 0);
        return bench::growthOf(&ProcessFigures::descriptors, samples);
    };
    EXPECT_EQ(growth({10, 14, 13, 12, 14, 11}), 0);
    EXPECT_EQ(growth({14, 13, 12, 11, 10, 9}), 0);
    EXPECT_EQ(growth({10, 11, 12, 13, 14, 15}), 3);
    EXPECT_EQ(growth({10, 11}), 0);
}

TEST(ProcessFigures, SlopeIsThatOfALine) {
    const std::vector<ProcessFigures> line{{0, 100}, {1800, 101}, {3600, 102}};
    EXPECT_NEAR(bench::residentSlope(line), 2, 1e-9);
    EXPECT_EQ(bench::residentSlope({}), 0);
}

}  // namespace
}  // namespace eyrie
