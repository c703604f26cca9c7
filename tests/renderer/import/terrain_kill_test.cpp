// SPDX-License-Identifier: Apache-2.0
// Imports whose process is killed, in each of their stages, and what the next one makes of it.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "renderer/import/geotiff_writer.h"
#include "renderer/import/terrain_import.h"
#include "tests/renderer/import/imagery_fixture.h"

namespace eyrie::import {
namespace {

using fabric::Rgba;
using testing::HasSubstr;

/// A strip, whose level 0 has a hundred pages and four hundred texture tiles: several batches.
constexpr int kColumns = 51'000;
constexpr int kRows = 16;
constexpr double kPostMetres = 2;
constexpr double kPixelMetres = 0.5;
constexpr std::uint64_t kMuch = std::uint64_t{1} << 30;  // nothing goes to the disk

/// What the process that is killed is told, since it begins the test anew.
constexpr const char* kFolder = "EYRIE_TERRAIN_KILL_TEST_FOLDER";

constexpr double kWhole = 2;

struct Moment {
    std::string stage;
    double fraction;  ///< of the stage
    /// How much of stages is kept by then for sure: all but the last two batches are.
    std::map<std::string, double> kept;
};

class TerrainKill : public testing::TestWithParam<Moment> {
protected:
    static void SetUpTestSuite() {
        if (std::getenv(kFolder) != nullptr)
            return;  // the process that is killed
        folder_.emplace();
        setenv(kFolder, folder_->path("").c_str(), 1);
        writePictures('a');
        ASSERT_TRUE(writeGeoTiff(test::slope(kColumns, kRows, kPostMetres), path("dem.tif")).ok());
        ASSERT_TRUE(import("whole.eyt", kMuch, {}).ok());
    }
    static void TearDownTestSuite() {
        if (!folder_)
            return;
        unsetenv(kFolder);
        folder_.reset();
    }

    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
    void TearDown() override {
        if (folder_)
            std::filesystem::remove(path("out.eyt"));
    }

    static std::string path(const std::string& name) { return std::getenv(kFolder) + name; }

    /// Two that set the spacing of texels all over the strip, far from each other.
    static void writePictures(char tint) {
        for (const int k : {0, 1})
            test::writePicture(path(k == 0 ? "west.tif" : "east.tif"),
                               {.west = test::kWest + 1000 + 90'000 * k,
                                .north = test::kSouth + 30,
                                .pixel = kPixelMetres,
                                .columns = 900,
                                .rows = 60,
                                .colour = [tint](double x, double y) {
                                    return Rgba{static_cast<std::uint8_t>(x),
                                                static_cast<std::uint8_t>(y * 3),
                                                static_cast<std::uint8_t>(tint), 255};
                                }});
    }

    static absl::Status import(const std::string& name, std::uint64_t memoryBytes,
                               const std::function<void(std::string_view, double)>& progress,
                               bool startsOver = false, const std::stop_token& stop = {}) {
        return importTerrain({path("dem.tif")}, path(name),
                             {.memoryBytes = memoryBytes,
                              .imagery = {path("west.tif"), path("east.tif")},
                              .startsOver = startsOver},
                             {progress, stop})
            .status();
    }

    static void importUntilKilled(const Moment& moment) {
        static_cast<void>(import("out.eyt", 1, [&](std::string_view stage, double fraction) {
            if (stage == moment.stage && fraction >= moment.fraction)
                kill(getpid(), SIGKILL);
        }));
    }

    /// With memory that fits.
    static absl::Status importUntilCalledOff(bool startsOver) {
        std::stop_source stop;
        return import(
            "out.eyt", kMuch,
            [&](std::string_view stage, double) {
                if (stage == "building")
                    stop.request_stop();
            },
            startsOver, stop.get_token());
    }

    /// Goes on, and fails the test unless that makes what `whole` is.
    void goOn(const std::string& whole, std::uint64_t memoryBytes = 1) {
        const absl::Status status =
            import("out.eyt", memoryBytes, [this](std::string_view stage, double fraction) {
                begun_.try_emplace(std::string(stage), fraction);
            });
        ASSERT_TRUE(status.ok()) << status;
        EXPECT_TRUE(test::contents(path("out.eyt")) == test::contents(path(whole)));
        EXPECT_THAT(left(), testing::IsEmpty());
    }

    /// What lies beside `out.eyt` and is for an import that goes on.
    static std::vector<std::string> left() {
        std::vector<std::string> files = folder_->files();
        std::erase_if(files, [](const std::string& file) {
            return file.find("scratch") == std::string::npos &&
                   file.find("partial") == std::string::npos;
        });
        return files;
    }

    static inline std::optional<test::TemporaryFolder> folder_;  ///< none where it is another's
    std::map<std::string, double> begun_;  ///< stages, and what was reported of them first
};

TEST_P(TerrainKill, GoesOnWithinTwoBatchesToTheSameBytes) {
    EXPECT_EXIT(importUntilKilled(GetParam()), testing::KilledBySignal(SIGKILL), "");
    EXPECT_FALSE(std::filesystem::exists(path("out.eyt")));
    goOn("whole.eyt");
    for (const auto& [stage, share] : GetParam().kept) {
        const auto begun = begun_.find(stage);
        EXPECT_TRUE(begun == begun_.end() || begun->second >= share) << stage << begun->second;
    }
}

std::map<std::string, double> measuredAnd(const std::string& stage, double share) {
    return {{"reading", kWhole}, {"measuring", kWhole}, {"joining", kWhole}, {stage, share}};
}

INSTANTIATE_TEST_SUITE_P(
    Moments, TerrainKill,
    testing::Values(Moment{"reading", 0.5, {}}, Moment{"measuring", 0.5, {}},
                    Moment{"joining", 0.5, {}}, Moment{"building", 0.1, {{"reading", kWhole}}},
                    Moment{"building", 0.6, measuredAnd("building", 0.3)},
                    Moment{"smoothing", 0.5, measuredAnd("building", 0.5)},
                    Moment{"thinning", 0.5, measuredAnd("building", 0.8)},
                    Moment{"building", 1, measuredAnd("building", 0.9)},
                    Moment{"imagery", 0.1, measuredAnd("building", 0.9)},
                    Moment{"imagery", 0.6, {{"building", kWhole}, {"imagery", 0.3}}},
                    Moment{"imagery", 1, {{"building", kWhole}, {"imagery", 0.9}}}),
    [](const auto& moment) { return std::to_string(moment.index) + "Of" + moment.param.stage; });

/// Of four stages.
std::vector<Moment> randomMoments() {
    std::vector<std::string> stages = {"reading",   "measuring", "joining", "building",
                                       "smoothing", "thinning",  "imagery"};
    std::mt19937 random(20261130);
    std::shuffle(stages.begin(), stages.end(), random);
    stages.resize(4);
    std::vector<Moment> moments;
    for (const std::string& stage : stages)
        moments.push_back({stage, std::uniform_real_distribution<double>(0, 0.9)(random), {}});
    return moments;
}

INSTANTIATE_TEST_SUITE_P(RandomMoments, TerrainKill, testing::ValuesIn(randomMoments()),
                         [](const auto& moment) {
                             return fmt::format("{}Of{}At{:.0f}Thousandths", moment.index,
                                                moment.param.stage, 1000 * moment.param.fraction);
                         });

/// They have the same sizes, and so have the tiles places that would fit.
TEST_F(TerrainKill, TakesNoTilesOfPicturesThatHaveChanged) {
    EXPECT_EXIT(importUntilKilled({"imagery", 0.6, {}}), testing::KilledBySignal(SIGKILL), "");
    writePictures('b');
    ASSERT_TRUE(import("changed.eyt", kMuch, {}).ok());
    goOn("changed.eyt");
    EXPECT_EQ(begun_.count("building"), 0U);
    EXPECT_LT(begun_["imagery"], 0.1) << "all of them are made again";
    writePictures('a');
}

TEST_F(TerrainKill, WithMemoryThatFitsLeavesNothingOfWhatDidNot) {
    EXPECT_EXIT(importUntilKilled({"imagery", 0.6, {}}), testing::KilledBySignal(SIGKILL), "");
    EXPECT_THAT(left(), testing::UnorderedElementsAre("out.eyt.partial", "out.eyt.scratch",
                                                      "out.eyt.scratch.journal"));
    goOn("whole.eyt", kMuch);
    EXPECT_EQ(begun_.count("reading"), 1U);
}

/// It took nothing from there, and made no less of it.
TEST_F(TerrainKill, CalledOffWithMemoryThatFitsLeavesTheOtherToGoOn) {
    EXPECT_EXIT(importUntilKilled({"imagery", 0.6, {}}), testing::KilledBySignal(SIGKILL), "");
    const std::vector<std::string> before = left();
    EXPECT_TRUE(absl::IsCancelled(importUntilCalledOff(false)));
    EXPECT_THAT(left(), testing::ElementsAreArray(before));
    goOn("whole.eyt");
    EXPECT_EQ(begun_.count("building"), 0U);
}

TEST_F(TerrainKill, ToldToStartOverLeavesNothingEvenIfItIsCalledOff) {
    EXPECT_EXIT(importUntilKilled({"imagery", 0.6, {}}), testing::KilledBySignal(SIGKILL), "");
    EXPECT_TRUE(absl::IsCancelled(importUntilCalledOff(true)));
    EXPECT_THAT(left(), testing::IsEmpty());
}

}  // namespace
}  // namespace eyrie::import
