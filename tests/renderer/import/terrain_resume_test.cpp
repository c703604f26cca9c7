// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/geotiff_writer.h"
#include "renderer/import/import_journal.h"
#include "renderer/import/shard_part.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_stages.h"
#include "renderer/import/terrain_synth.h"
#include "tests/renderer/import/file_size_limit.h"
#include "tests/renderer/import/terrain_fixture.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

/// What is reported, and with what an import begins that goes on after an abort there.
constexpr std::pair<const char*, const char*> kStages[] = {
    {"reading", "reading"},   {"measuring", "measuring"}, {"joining", "measuring"},
    {"building", "building"}, {"smoothing", "smoothing"}, {"thinning", "thinning"}};

/// Too large for the 4 MiB that a scratch has at least.
const terrain::HeightGrid& largeGrid() {
    static const terrain::HeightGrid grid = synthesizeTerrain(800, 4);
    return grid;
}

class TerrainResume : public testing::Test {
protected:
    absl::Status import(const std::string& out, const ImportControl& control = {},
                        const TerrainImportOptions& how = {.memoryBytes = 1}) const {
        GridHeightSource posts(largeGrid());
        return importTerrain(posts, {"grid", "", 77}, out, how, control).status();
    }

    /// Called off in the middle of `stage`; the stages that were begun are noted in `begun`.
    absl::Status importUntil(const std::string& stage, const std::string& out) {
        std::stop_source stop;
        ImportControl control;
        control.stop = stop.get_token();
        begun_.clear();
        control.progress = [&](std::string_view reached, double fraction) {
            if (begun_.empty() || begun_.back() != reached)
                begun_.emplace_back(reached);
            if (reached == stage && fraction > 0.3)
                stop.request_stop();
        };
        return import(out, control);
    }

    test::TemporaryFolder folder_;
    std::vector<std::string> begun_;
};

TEST_F(TerrainResume, GivesTheSameBytesAfterAnAbortInEachStage) {
    const std::string whole = folder_.path("whole.eyt");
    ASSERT_TRUE(import(whole, {}, {}).ok());
    for (const auto& [stage, first] : kStages) {
        const std::string out = folder_.path(std::string(stage) + ".eyt");
        const absl::Status aborted = importUntil(stage, out);
        EXPECT_EQ(aborted.code(), absl::StatusCode::kCancelled) << stage << aborted;
        EXPECT_THAT(aborted.ToString(), HasSubstr("goes on")) << stage;
        EXPECT_FALSE(std::filesystem::exists(out)) << stage;
        EXPECT_TRUE(std::filesystem::exists(out + ".scratch.journal")) << stage;
        ASSERT_TRUE(importUntil("never", out).ok()) << stage;
        EXPECT_EQ(begun_.front(), first) << "the stages before it were not run again";
        EXPECT_EQ(test::contents(out), test::contents(whole)) << stage;
        EXPECT_FALSE(std::filesystem::exists(out + ".scratch")) << stage;
        EXPECT_FALSE(std::filesystem::exists(out + ".scratch.journal")) << stage;
        EXPECT_FALSE(std::filesystem::exists(out + ".partial")) << stage;
    }
}

TEST_F(TerrainResume, MayHaveTheLongestNameBesideOnesThatAreNearlyTheSame) {
    const std::string first = folder_.path(std::string(250, 'a') + "1.eyt");
    const std::string second = folder_.path(std::string(250, 'a') + "2.eyt");
    for (const std::string& out : {first, second})
        EXPECT_EQ(importUntil("thinning", out).code(), absl::StatusCode::kCancelled);
    for (const std::string& out : {first, second}) {
        const absl::Status status = importUntil("never", out);
        ASSERT_TRUE(status.ok()) << status;
        EXPECT_EQ(begun_.front(), "thinning");
    }
    EXPECT_EQ(folder_.files().size(), 2U);
    const std::string how = folder_.path(std::string(251, 'b') + ".eyt");
    EXPECT_TRUE(import(how, {}, {.memoryBytes = 1, .scratchFolder = folder_.path("")}).ok());
}

TEST_F(TerrainResume, MakesPagesAnewThatAreNotInThePartialFileAsTheyWere) {
    const std::string whole = folder_.path("whole.eyt");
    ASSERT_TRUE(import(whole, {}, {}).ok());
    const std::string out = folder_.path("a.eyt");
    const std::string partial = out + ".partial";
    const std::function<void()> damages[] = {
        [&] { std::filesystem::remove(partial); },
        [&] { std::filesystem::resize_file(partial, std::filesystem::file_size(partial) / 2); },
        [&] { std::ofstream(partial, std::ios::app) << std::string(10'000'000, 'x'); },
        [&] {
            std::fstream file(partial, std::ios::in | std::ios::out | std::ios::binary);
            file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(partial) / 2));
            file.put('\x5a');
        }};
    for (const std::function<void()>& damage : damages) {
        ASSERT_FALSE(importUntil("thinning", out).ok());
        damage();
        ASSERT_TRUE(import(out).ok());
        EXPECT_EQ(test::contents(out), test::contents(whole));
    }
}

TEST_F(TerrainResume, RefusesASecondImportIntoTheSameFile) {
    const std::string out = folder_.path("a.eyt");
    std::filesystem::create_directory(folder_.path("scratch"));
    absl::Status second;
    ImportControl control;
    control.progress = [&](std::string_view stage, double) {
        if (stage == "thinning" && second.ok())
            second = import(out, {}, {.memoryBytes = 1, .scratchFolder = folder_.path("scratch")});
    };
    ASSERT_TRUE(import(out, control, {.memoryBytes = 1, .threads = 1}).ok());
    EXPECT_EQ(second.code(), absl::StatusCode::kFailedPrecondition) << second;
    EXPECT_THAT(second.ToString(), HasSubstr("a.eyt: another import"));
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path("scratch")));
}

TEST_F(TerrainResume, WritesThroughNoLinkThatHasANameOfItsFiles) {
    const std::string out = folder_.path("a.eyt");
    const std::string other = folder_.path("other");
    for (const char* ending : {".partial", ".scratch", ".scratch.journal"}) {
        std::ofstream(other) << "another's";
        std::filesystem::create_symlink(other, out + ending);
        const absl::Status status = import(out);
        EXPECT_TRUE(status.ok() || status.ToString().find(out + ending) != std::string::npos)
            << status;
        EXPECT_EQ(std::filesystem::file_size(other), 9U) << ending;
        EXPECT_FALSE(std::filesystem::is_symlink(out)) << ending;
        for (const std::string& file : folder_.files()) std::filesystem::remove(folder_.path(file));
    }
}

TEST_F(TerrainResume, SaysAgainWhatWasFoundInPostsThatAreNotReadAgain) {
    const std::string dem = folder_.path("dem.tif");
    const std::string out = folder_.path("a.eyt");
    terrain::HeightGrid grid = largeGrid();
    grid.heights[5] = 3e37F;
    ASSERT_TRUE(writeGeoTiff(grid, dem).ok());
    std::stop_source stop;
    ImportControl control;
    control.stop = stop.get_token();
    std::vector<std::string> begun;
    control.progress = [&](std::string_view stage, double) {
        begun.emplace_back(stage);
        if (stage == "building")
            stop.request_stop();
    };
    const std::vector<std::string> dems{dem};
    ASSERT_FALSE(importTerrain(dems, out, {.memoryBytes = 1}, control).ok());
    control.stop = {};
    begun.clear();
    const auto report = importTerrain(dems, out, {.memoryBytes = 1}, control);
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_THAT(begun, testing::Not(testing::Contains("reading")));
    EXPECT_THAT(report->notes,
                testing::ElementsAre(HasSubstr("can be no height"), HasSubstr("MB of memory")));
}

TEST_F(TerrainResume, StartsOverForOtherOptionsOrWhenToldSo) {
    const std::string out = folder_.path("a.eyt");
    ASSERT_FALSE(importUntil("building", out).ok());
    begun_.clear();
    ImportControl control;
    control.progress = [&](std::string_view stage, double) { begun_.emplace_back(stage); };
    ASSERT_TRUE(import(out, control, {.memoryBytes = 1, .errorMetres = 5}).ok());
    EXPECT_EQ(begun_.front(), "reading");
    ASSERT_FALSE(importUntil("building", out).ok());
    begun_.clear();
    ASSERT_TRUE(import(out, control, {.memoryBytes = 1, .startsOver = true}).ok());
    EXPECT_EQ(begun_.front(), "reading");
}

TEST_F(TerrainResume, GoesOnWithWhatThisVersionHasDoneAlone) {
    const std::string out = folder_.path("a.eyt");
    ASSERT_FALSE(importUntil("building", out).ok());
    const auto isJournalOf = [&](const PartIdentity& identity) {
        const auto journal =
            ImportJournal::open(out + ".scratch.journal", stagesKey(identity, 0), false);
        return journal.ok() && !journal->isEmpty();
    };
    PartIdentity identity = identityOf(largeGrid().frame(), 77, -1, 0, 1);
    EXPECT_TRUE(isJournalOf(identity));
    identity.programVersion = {'9', '.', '9'};
    EXPECT_FALSE(isJournalOf(identity));
}

TEST_F(TerrainResume, GoesOnAfterADamagedJournal) {
    const std::string whole = folder_.path("whole.eyt");
    ASSERT_TRUE(import(whole, {}, {}).ok());
    const std::string out = folder_.path("a.eyt");
    for (const double share : {0.0, 0.01, 0.5, 0.999}) {
        ASSERT_FALSE(importUntil("building", out).ok());
        const std::string journal = out + ".scratch.journal";
        const auto size = static_cast<double>(std::filesystem::file_size(journal));
        std::fstream file(journal, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(size * share));
        file.put('\x5a');
        file.close();
        ASSERT_TRUE(import(out).ok());
        EXPECT_EQ(test::contents(out), test::contents(whole)) << share;
    }
}

TEST_F(TerrainResume, StartsOverWhereTheScratchIsNoLongerWhole) {
    const std::string whole = folder_.path("whole.eyt");
    ASSERT_TRUE(import(whole, {}, {}).ok());
    const std::string out = folder_.path("a.eyt");
    const std::string scratch = out + ".scratch";
    const std::function<void()> damages[] = {
        [&] { std::filesystem::remove(scratch); },
        [&] { std::filesystem::resize_file(scratch, 0); },
        [&] { std::filesystem::resize_file(scratch, std::filesystem::file_size(scratch) / 4); }};
    for (const std::function<void()>& damage : damages) {
        ASSERT_FALSE(importUntil("thinning", out).ok());
        damage();
        ASSERT_TRUE(importUntil("never", out).ok());
        EXPECT_EQ(begun_.front(), "reading");
        EXPECT_EQ(test::contents(out), test::contents(whole));
    }
}

/// As long as before, so that it looks whole.
TEST_F(TerrainResume, SaysThatTheScratchWasOverwrittenAndStartsOverThen) {
    const std::string whole = folder_.path("whole.eyt");
    ASSERT_TRUE(import(whole, {}, {}).ok());
    const std::string out = folder_.path("a.eyt");
    for (const char* stage : {"measuring", "thinning"}) {
        ASSERT_FALSE(importUntil(stage, out).ok());
        const std::string scratch = out + ".scratch";
        const std::string others(std::filesystem::file_size(scratch), '\x5a');
        std::ofstream(scratch, std::ios::binary) << others;
        const absl::Status status = import(out);
        EXPECT_TRUE(absl::IsDataLoss(status)) << status;
        EXPECT_THAT(status.ToString(), HasSubstr(scratch + ": scratch file has something else"));
        EXPECT_THAT(status.ToString(), testing::Not(HasSubstr("goes on from there")));
        EXPECT_EQ(folder_.files(), std::vector<std::string>{"whole.eyt"}) << stage;
        ASSERT_TRUE(importUntil("never", out).ok());
        EXPECT_EQ(begun_.front(), "reading");
        EXPECT_EQ(test::contents(out), test::contents(whole));
        std::filesystem::remove(out);
    }
}

TEST_F(TerrainResume, SaysWhatIsWrongWithTheScratchFolder) {
    const absl::Status status = import(folder_.path("a.eyt"), {},
                                       {.memoryBytes = 1, .scratchFolder = folder_.path("none")});
    EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(status.ToString(), HasSubstr("none"));
    EXPECT_TRUE(folder_.files().empty());
}

/// As it says itself where its disk is full.
TEST_F(TerrainResume, MakesRoomWhereItStartsOverWithAScratchElsewhere) {
    const std::string out = folder_.path("a.eyt");
    std::filesystem::create_directory(folder_.path("scratch"));
    ASSERT_FALSE(importUntil("building", out).ok());
    ASSERT_TRUE(std::filesystem::exists(out + ".scratch"));
    ImportControl control;
    control.progress = [&](std::string_view, double) {
        EXPECT_FALSE(std::filesystem::exists(out + ".scratch"));
        EXPECT_FALSE(std::filesystem::exists(out + ".scratch.journal"));
    };
    const absl::Status status =
        import(out, control, {.memoryBytes = 1, .scratchFolder = folder_.path("scratch")});
    EXPECT_TRUE(status.ok()) << status;
}

TEST_F(TerrainResume, MakesRoomWhereThereIsNotEvenAnyForAJournal) {
    const std::string scratch = folder_.path("a.eyt.scratch");
    std::ofstream(scratch) << "posts";
    const test::FileSizeLimit full(0);
    TerrainStages::removeLeftovers(scratch);
    EXPECT_TRUE(folder_.files().empty());
}

TEST_F(TerrainResume, IsTheSameForAnyMemoryThreadsAndScratchFolder) {
    const std::string a = folder_.path("a.eyt");
    const std::string b = folder_.path("b.eyt");
    std::filesystem::create_directory(folder_.path("scratch"));
    ASSERT_TRUE(import(a, {}, {}).ok());
    ASSERT_TRUE(
        import(b, {}, {.memoryBytes = 1, .scratchFolder = folder_.path("scratch"), .threads = 1})
            .ok());
    EXPECT_EQ(test::contents(a), test::contents(b));
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path("scratch")));
}

TEST(ImportJournal, GivesBackWhatWasAddedForTheSameKeyOnly) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("journal");
    const std::vector<std::byte> state(1000, std::byte{7});
    {
        auto journal = ImportJournal::open(path, 5, false);
        ASSERT_TRUE(journal.ok()) << journal.status();
        ASSERT_TRUE(journal->add(0, std::vector<std::byte>{}, 0).ok());
        ASSERT_TRUE(journal->add(1, state, 0).ok());
        EXPECT_EQ(ImportJournal::open(path, 5, false).status().code(),
                  absl::StatusCode::kFailedPrecondition);
    }
    {
        auto journal = ImportJournal::open(path, 5, false);
        ASSERT_TRUE(journal.ok()) << journal.status();
        ASSERT_NE(journal->find(1), nullptr);
        EXPECT_EQ(*journal->find(1), state);
        EXPECT_EQ(journal->find(2), nullptr);
    }
    auto other = ImportJournal::open(path, 6, false);
    ASSERT_TRUE(other.ok());
    EXPECT_TRUE(other->isEmpty());
}

TEST(ImportJournal, ForgetsForGoodWhatFollowedAStepThatIsDoneAgain) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("journal");
    const std::vector<std::byte> state(10, std::byte{7});
    {
        auto journal = ImportJournal::open(path, 5, false);
        ASSERT_TRUE(journal.ok());
        for (std::uint32_t step = 0; step < 4; ++step)
            ASSERT_TRUE(journal->add(step, state, 0).ok());
    }
    {
        auto journal = ImportJournal::open(path, 5, false);
        ASSERT_TRUE(journal.ok());
        journal->release(0);
        ASSERT_TRUE(journal->dropFrom(2).ok());
        EXPECT_NE(journal->find(1), nullptr);
        EXPECT_EQ(journal->find(3), nullptr);
        ASSERT_TRUE(journal->add(2, state, 0).ok());
    }
    auto journal = ImportJournal::open(path, 5, false);
    ASSERT_TRUE(journal.ok());
    for (std::uint32_t step = 0; step < 3; ++step) EXPECT_NE(journal->find(step), nullptr) << step;
    EXPECT_EQ(journal->find(3), nullptr);
}

/// Cut anywhere, a journal keeps the records before the cut and takes new ones after them.
TEST(ImportJournal, LeavesNoFileWhereTheDiskIsFull) {
    const test::TemporaryFolder folder;
    const test::FileSizeLimit full(0);
    EXPECT_FALSE(ImportJournal::open(folder.path("j"), 5, false).ok());
    EXPECT_TRUE(folder.files().empty());
}

TEST(ImportJournal, KeepsWholeRecordsOfACutFile) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("journal");
    {
        auto journal = ImportJournal::open(path, 5, false);
        ASSERT_TRUE(journal.ok());
        for (std::uint32_t step = 0; step < 3; ++step)
            ASSERT_TRUE(journal->add(step, std::vector<std::byte>(50, std::byte{1}), step).ok());
    }
    const std::string whole = test::contents(path);
    std::size_t most = 0;
    for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
        std::ofstream(path, std::ios::binary) << whole.substr(0, cut);
        std::uint32_t kept = 0;
        {
            auto journal = ImportJournal::open(path, 5, false);
            ASSERT_TRUE(journal.ok());
            while (journal->find(kept) != nullptr) ++kept;
            ASSERT_TRUE(journal->add(kept, std::vector<std::byte>{}, 9).ok());
        }
        auto again = ImportJournal::open(path, 5, false);
        ASSERT_TRUE(again.ok());
        EXPECT_NE(again->find(kept), nullptr) << cut;
        EXPECT_EQ(again->resultBytes(), 9U) << cut;
        EXPECT_GE(kept, most);
        most = kept;
    }
    EXPECT_EQ(most, 3U);
}

}  // namespace
}  // namespace eyrie::import
