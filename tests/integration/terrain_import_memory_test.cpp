// SPDX-License-Identifier: Apache-2.0
// The import as people run it: how much memory it takes, and what a kill leaves.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/nginx.h"
#include "tests/support/peak_memory.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using Words = std::vector<std::string>;

class TerrainImportProcess : public testing::Test {
protected:
    void synthesize(int posts) {
        ASSERT_TRUE(test::succeeded({"synth", "terrain", "--size", std::to_string(posts), "-o",
                                     folder_.path("dem.tif"), "--quiet"}));
    }
    Words importInto(const std::string& out, const std::string& memory) const {
        return {"import", "terrain",         folder_.path("dem.tif"),
                "-o",     folder_.path(out), "--memory",
                memory,   "--error",         "20"};
    }
    std::string bytesOf(const std::string& name) const {
        std::ifstream file(folder_.path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    test::TemporaryFolder folder_;
};

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // those take their own
/// In bytes; -1 when the program failed.
std::int64_t peakBytes(const Words& command) {
    const test::Peak peak = test::peakOf(command);
    return peak.status == 0 ? peak.bytes : -1;
}

TEST_F(TerrainImportProcess, StaysWithinItsMemory) {
    synthesize(6000);  // 36 M posts: 335 MB of heights, levels and smoothed heights
    Words arguments = importInto("dem.eyt", "192M");
    arguments.emplace_back("--quiet");
    const std::int64_t peak = peakBytes(test::eyrieCommand(arguments));
    ASSERT_GT(peak, 0);
    EXPECT_LE(peak, std::int64_t{192} << 20);
    EXPECT_FALSE(std::filesystem::exists(folder_.path("dem.eyt.scratch")));
}

TEST_F(TerrainImportProcess, StaysWithinItsMemoryWhileItReprojects) {
    synthesize(6000);
    std::ofstream(folder_.path("degrees.vrt"))
        << R"(<VRTDataset rasterXSize="6000" rasterYSize="6000">
  <SRS>EPSG:4326</SRS><GeoTransform>8, 0.0003, 0, 47, 0, -0.0003</GeoTransform>
  <VRTRasterBand dataType="Float32" band="1"><SimpleSource>
    <SourceFilename relativeToVRT="1">dem.tif</SourceFilename><SourceBand>1</SourceBand>
  </SimpleSource></VRTRasterBand>
</VRTDataset>)";
    Words arguments = importInto("dem.eyt", "256M");
    arguments[2] = folder_.path("degrees.vrt");
    arguments.emplace_back("--quiet");
    const std::int64_t peak = peakBytes(test::eyrieCommand(arguments));
    ASSERT_GT(peak, 0);
    EXPECT_LE(peak, std::int64_t{256} << 20);
}

TEST_F(TerrainImportProcess, HoldsNoWholeFileOfAUrl) {
    synthesize(6000);  // 144 MB
    const test::Nginx nginx(folder_.path());
    Words arguments = importInto("dem.eyt", "192M");
    arguments[2] = nginx.url("dem.tif");
    arguments.emplace_back("--quiet");
    const std::int64_t peak = peakBytes(test::eyrieCommand(arguments));
    ASSERT_GT(peak, 0);
    EXPECT_LE(peak, std::int64_t{192 + 32} << 20) << "32M: libcurl and what GDAL keeps of URLs";
}

TEST_F(TerrainImportProcess, StaysWithinItsMemorySharded) {
    synthesize(4000);  // 16 M posts: 48 MB of heights and levels a shard and 149 MB at the merge
    for (const Words& share : {Words{"--shard", "0/2"}, {"--shard", "1/2"}, {"--merge"}}) {
        Words arguments = importInto("dem.eyt", "192M");
        arguments.emplace_back("--quiet");
        arguments.insert(arguments.end(), share.begin(), share.end());
        const std::int64_t peak = peakBytes(test::eyrieCommand(arguments));
        ASSERT_GT(peak, 0) << share.back();
        EXPECT_LE(peak, std::int64_t{192} << 20) << share.back();
    }
}
#endif

TEST_F(TerrainImportProcess, GoesOnAfterAKill) {
    synthesize(2600);
    ASSERT_TRUE(test::succeeded(importInto("whole.eyt", "512M")));
    {
        test::Process killed(test::eyrieCommand(importInto("dem.eyt", "192M")));
        ASSERT_TRUE(test::eventually(seconds(60), [&] {
            return killed.errors().find("building") != std::string::npos;
        })) << killed.errors();
        killed.send(SIGKILL);
        ASSERT_TRUE(killed.waitFor(seconds(20)).has_value());
    }
    EXPECT_FALSE(std::filesystem::exists(folder_.path("dem.eyt")));
    const test::Outcome again = test::eyrie(importInto("dem.eyt", "192M"));
    EXPECT_EQ(again.exit, (test::Exit{0, 0})) << again.errors;
    // The stage before was still being kept, perhaps; the one before that was.
    EXPECT_EQ(again.errors.find("reading"), std::string::npos) << again.errors;
    EXPECT_EQ(bytesOf("dem.eyt"), bytesOf("whole.eyt"));
    EXPECT_EQ(test::namesIn(folder_.path()),
              (std::set<std::string>{"dem.eyt", "dem.eyt.source", "dem.tif", "whole.eyt",
                                     "whole.eyt.source"}));
}

TEST_F(TerrainImportProcess, SaysHowToGoOnWhenInterrupted) {
    synthesize(2600);
    test::Process stopped(test::eyrieCommand(importInto("dem.eyt", "192M")));
    ASSERT_TRUE(test::eventually(seconds(60), [&] {
        return stopped.errors().find("building") != std::string::npos;
    })) << stopped.errors();
    stopped.send(SIGINT);
    ASSERT_TRUE(stopped.waitFor(seconds(20)).has_value());
    EXPECT_NE(stopped.errors().find("the same command goes on"), std::string::npos)
        << stopped.errors();
    EXPECT_TRUE(std::filesystem::exists(folder_.path("dem.eyt.scratch")));
    EXPECT_FALSE(std::filesystem::exists(folder_.path("dem.eyt")));
}

}  // namespace
}  // namespace eyrie
