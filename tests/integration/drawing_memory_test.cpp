// SPDX-License-Identifier: Apache-2.0
// How much memory a process takes that draws more than it may keep.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/image_files.h"
#include "tests/support/json.h"
#include "tests/support/peak_memory.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // those take their own
constexpr std::int64_t kMebi = std::int64_t{1} << 20;
/// For what is in neither limit: what OpenGL in software makes of the triangles of a frame, pages
/// while they are decoded, and what the allocator keeps of either.
constexpr std::int64_t kRoom = 64 * kMebi;

class HardCase23 : public testing::Test {
protected:
    std::string terrain(const std::string& posts) const {
        const std::string dem = folder_.path(posts + ".tif");
        const std::string out = folder_.path(posts + ".eyt");
        EXPECT_TRUE(
            test::succeeded({"synth", "terrain", "--size", posts, "--seed", "3", "-o", dem}));
        EXPECT_TRUE(test::succeeded({"import", "terrain", dem, "-o", out}));
        return out;
    }

    /// Of a flight over all of it that asks for every post. llvmpipe's threads are two, whatever
    /// the machine has.
    std::int64_t peakBytes(const std::string& data) const {
        std::vector<std::string> words =
            test::eyrieCommand({"bench", data, "--flight", "worst", "--tau", "0.05", "--size",
                                "320x180", "--frames", "8", "--repeats", "1", "--memory", "4M",
                                "--host-memory", "8M", "--quiet", "-o", report()});
        words.insert(words.begin(), {"/usr/bin/env", "LP_NUM_THREADS=2"});
        const test::Peak peak = test::peakOf(words);
        EXPECT_EQ(peak.status, 0);
        return peak.bytes;
    }
    std::string report() const { return folder_.path("report"); }

    test::TemporaryFolder folder_;
};

/// The program's base is what the same flight takes over 17 x 17 posts.
TEST_F(HardCase23, AProcessStaysWithinItsLimitsBesideWhatTheProgramTakes) {
    const std::int64_t base = peakBytes(terrain("17"));
    ASSERT_GT(base, 0);
    const std::int64_t peak = peakBytes(terrain("2049"));
    EXPECT_LE(peak, base + (4 + 8) * kMebi + kRoom) << "base: " << base;
    const auto summary = test::readFile(report() + "/summary.json");
    ASSERT_TRUE(summary.ok()) << summary.status();
    const auto runs = test::list(test::parseJson(*summary), "runs");
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_GT(test::number(runs[0], "tauAchievedMax"), 0.05) << "which does not fit";
}
#endif

}  // namespace
}  // namespace eyrie
