// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_shard.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/geotiff_writer.h"
#include "renderer/import/shard_part.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/import/whole_file.h"
#include "tests/renderer/import/file_size_limit.h"
#include "tests/renderer/import/imagery_fixture.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::import {
namespace {

using test::contents;
using test::GridKind;
using testing::AllOf;
using testing::HasSubstr;

std::set<std::string> namesIn(const std::string& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    return names;
}

constexpr TerrainImportOptions kMerge = {.mergesParts = true};

class TerrainShards : public testing::Test {
protected:
    std::string out() const { return folder_.path(name_); }

    static TerrainSource source(std::uint64_t hash = 7) { return {"grid", "", hash}; }

    absl::Status shard(const terrain::HeightGrid& grid, const Shard& which,
                       const TerrainImportOptions& how = {}, const ImportControl& control = {}) {
        GridHeightSource posts(grid);
        return importTerrainShard(posts, source(), out(), which, how, control).status();
    }
    absl::Status merge(const terrain::HeightGrid& grid, TerrainImportOptions how = kMerge,
                       std::uint64_t hash = 7) {
        GridHeightSource posts(grid);
        how.mergesParts = true;
        return importTerrain(posts, source(hash), out(), how, {}).status();
    }
    std::string whole(const terrain::HeightGrid& grid, const TerrainImportOptions& how = {}) {
        GridHeightSource posts(grid);
        const std::string path = folder_.path("whole.eyt");
        EXPECT_TRUE(importTerrain(posts, source(), path, how, {}).ok());
        return contents(path);
    }
    /// All shards, the last first, and the merge.
    absl::Status sharded(const terrain::HeightGrid& grid, std::uint32_t count,
                         const TerrainImportOptions& how = {}) {
        for (std::uint32_t k = count; k-- > 0;)
            if (absl::Status status = shard(grid, {k, count}, how); !status.ok())
                return status;
        return merge(grid, how);
    }
    std::string part(std::uint32_t index, std::uint32_t count) const {
        return partPath(out(), {index, count});
    }

    test::TemporaryFolder folder_;
    std::string name_ = "out.eyt";
};

/// Six squares of 512 cells, two of them whole.
terrain::HeightGrid grid(std::uint64_t seed = 1) {
    const terrain::HeightGrid whole = synthesizeTerrain(1100, seed);
    terrain::HeightGrid part{.columns = 1100, .rows = 560, .heights = {}};
    part.heights.assign(whole.heights.begin(), whole.heights.begin() + 1100 * 560);
    part.perColumn = whole.perColumn;
    part.perRow = whole.perRow;
    return part;
}

terrain::HeightGrid withHoles(terrain::HeightGrid grid) {
    test::Random random(5);
    for (float& h : grid.heights)
        if (random.integer(0, 999) == 0)
            h = terrain::kNodata;
    for (std::int32_t j = 500; j < 530; ++j)  // on the border of squares, and of shards
        for (std::int32_t i = 300; i < 900; ++i) grid.row(j)[i] = terrain::kNodata;
    return grid;
}

TEST_F(TerrainShards, MakeTheSameBytesAsOneImport) {
    const terrain::HeightGrid posts = grid();
    const std::string expected = whole(posts);
    for (const std::uint32_t count : {1U, 2U, 3U, 5U, 9U}) {  // 9: more than there are squares
        ASSERT_TRUE(sharded(posts, count).ok()) << count;
        EXPECT_TRUE(contents(out()) == expected) << count;
        EXPECT_FALSE(std::filesystem::exists(partsFolder(out()))) << count;
        std::filesystem::remove(out());
    }
}

TEST_F(TerrainShards, MayMakeAFileOfTheLongestName) {
    const terrain::HeightGrid posts = grid();
    const std::string expected = whole(posts);
    name_.insert(0, 255 - name_.size(), 'a');
    const absl::Status status = sharded(posts, 2, {.memoryBytes = 1});
    ASSERT_TRUE(status.ok()) << status;
    EXPECT_TRUE(contents(out()) == expected);
    EXPECT_EQ(folder_.files().size(), 2U);
}

TEST_F(TerrainShards, MakeTheSameBytesWithHolesAnErrorAndLittleMemory) {
    const terrain::HeightGrid posts = withHoles(grid(3));
    const TerrainImportOptions how = {.memoryBytes = 1, .errorMetres = 2, .threads = 1};
    const std::string expected = whole(posts, how);
    ASSERT_TRUE(sharded(posts, 4, how).ok());
    EXPECT_TRUE(contents(out()) == expected);
    EXPECT_EQ(folder_.files(), (std::vector<std::string>{"out.eyt", "whole.eyt"}));
}

/// Heights in whole metres but for one shard's: all must store them in finer steps.
TEST_F(TerrainShards, AgreeOnTheStepOfHeights) {
    terrain::HeightGrid posts = test::hardGrid(GridKind::Terraces, 40, 1500, 1);
    posts.row(1490)[3] = 0.5F;
    const std::string expected = whole(posts);
    ASSERT_TRUE(sharded(posts, 3).ok());
    EXPECT_TRUE(contents(out()) == expected);
}

TEST_F(TerrainShards, MakeTheSameBytesOfNastyGridsOfAnySize) {
    test::Random random(11);
    for (int k = 0; k < 3 * test::kGridKinds; ++k) {
        const auto kind = static_cast<GridKind>(k % test::kGridKinds);
        std::int32_t columns = random.integer(2, 34);
        std::int32_t rows = random.integer(2, 1400);
        if (random.integer(0, 1) == 1)
            std::swap(columns, rows);
        terrain::HeightGrid posts =
            test::hardGrid(kind, columns, rows, static_cast<std::uint64_t>(k));
        if (random.integer(0, 2) == 0)
            for (float& h : posts.heights) h = random.integer(0, 50) == 0 ? terrain::kNodata : h;
        const auto count = static_cast<std::uint32_t>(random.integer(1, 6));
        const std::string expected = whole(posts);
        ASSERT_TRUE(sharded(posts, count).ok()) << columns << " x " << rows;
        EXPECT_TRUE(contents(out()) == expected)
            << test::name(kind) << " " << columns << " x " << rows << " in " << count;
    }
}

TEST_F(TerrainShards, MakeTheSameBytesOfWarpedMosaicsWithImagery) {
    terrain::HeightGrid fine = synthesizeTerrain(620, 2);
    terrain::HeightGrid coarse = synthesizeTerrain(400, 6);
    coarse.perColumn = coarse.perColumn * 2.7;
    coarse.perRow = coarse.perRow * 2.7;
    ASSERT_TRUE(writeGeoTiff(fine, folder_.path("fine.tif")).ok());
    ASSERT_TRUE(writeGeoTiff(coarse, folder_.path("coarse.tif")).ok());
    const std::vector<std::string> dems = {folder_.path("coarse.tif"), folder_.path("fine.tif")};
    const double side = fine.perColumn.x * 400;
    test::writePicture(folder_.path("p.tif"),
                       {.epsg = test::kUtm33,
                        .west = fine.origin.x,
                        .north = fine.origin.y + side,
                        .pixel = side / 300,
                        .columns = 300,
                        .rows = 300,
                        .colour = [](double x, double y) {
                            return fabric::Rgba{static_cast<std::uint8_t>(static_cast<int>(x) / 64),
                                                static_cast<std::uint8_t>(static_cast<int>(y) / 64),
                                                99, 255};
                        }});
    const TerrainImportOptions how = {.imagery = {folder_.path("p.tif")}};
    const std::string single = folder_.path("whole.eyt");
    const auto made = importTerrain(dems, single, how, {});
    ASSERT_TRUE(made.ok()) << made.status();
    ASSERT_GT(made->columns, 1000);
    for (const std::uint32_t k : {1U, 0U, 2U}) {
        const auto report = importTerrainShard(dems, out(), {k, 3}, how, {});
        ASSERT_TRUE(report.ok()) << report.status();
        EXPECT_GT(report->posts, 0U);
        EXPECT_GT(report->textures, 1U);
        EXPECT_THAT(report->notes, testing::IsSupersetOf({HasSubstr("coarse.tif resampled"),
                                                          HasSubstr("imagery of")}));
    }
    TerrainImportOptions merging = how;
    merging.mergesParts = true;
    TerrainImportOptions without = merging;
    without.imagery = {};
    const absl::Status refused = importTerrain(dems, out(), without, {}).status();
    EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
    EXPECT_THAT(refused.ToString(), HasSubstr("is made with --imagery"));
    ASSERT_TRUE(importTerrain(dems, out(), merging, {}).ok());
    EXPECT_TRUE(contents(out()) == contents(single));
}

TEST_F(TerrainShards, GoOnAfterAnAbortInEachStage) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 200, 900, 1);
    const std::string expected = whole(posts);
    for (const char* stage : {"reading", "surveying", "measuring", "joining", "building"}) {
        std::stop_source stop;
        ImportControl control;
        control.stop = stop.get_token();
        control.progress = [&](std::string_view reached, double) {
            if (reached == stage)
                stop.request_stop();
        };
        const TerrainImportOptions how = {.memoryBytes = 1};
        EXPECT_EQ(shard(posts, {0, 2}, how, control).code(), absl::StatusCode::kCancelled) << stage;
        EXPECT_FALSE(std::filesystem::exists(part(0, 2))) << stage;
        EXPECT_TRUE(absl::IsNotFound(merge(posts))) << stage;
        ASSERT_TRUE(sharded(posts, 2, how).ok()) << stage;
        EXPECT_TRUE(contents(out()) == expected) << stage;
        EXPECT_FALSE(std::filesystem::exists(partsFolder(out()))) << stage;
    }
}

TEST_F(TerrainShards, KeepAWholePartAndReplaceADamagedOne) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 600, 40, 1);
    ASSERT_TRUE(shard(posts, {1, 2}).ok());
    const std::string made = contents(part(1, 2));
    GridHeightSource again(posts);
    auto report = importTerrainShard(again, source(), out(), {1, 2}, {}, {});
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_TRUE(report->wasThere);
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, made.size() / 2}) {
        std::ofstream(part(1, 2), std::ios::binary) << made.substr(0, size);
        report = importTerrainShard(again, source(), out(), {1, 2}, {}, {});
        ASSERT_TRUE(report.ok()) << report.status();
        EXPECT_FALSE(report->wasThere) << size;
        EXPECT_EQ(contents(part(1, 2)), made) << size;
    }
}

/// Killed right after, or with less memory before.
TEST_F(TerrainShards, ThatAreWholeLeaveNoScratch) {
    const terrain::HeightGrid posts = grid();
    const std::string scratch = part(0, 2) + ".scratch";
    for (const bool isThere : {false, true}) {
        std::filesystem::create_directory(partsFolder(out()));
        std::ofstream(scratch) << "posts";
        std::ofstream(scratch + ".journal") << "stages";
        ASSERT_TRUE(shard(posts, {0, 2}).ok());
        EXPECT_FALSE(std::filesystem::exists(scratch)) << isThere;
        EXPECT_FALSE(std::filesystem::exists(scratch + ".journal")) << isThere;
        EXPECT_TRUE(std::filesystem::exists(part(0, 2))) << isThere;
    }
}

TEST_F(TerrainShards, MayBeDoneTwiceAtTheSameTime) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 700, 600, 1);
    const std::string expected = whole(posts);
    std::vector<std::thread> threads;
    std::array<absl::Status, 4> statuses;
    for (std::uint32_t k = 0; k < 4; ++k)
        threads.emplace_back([&, k] { statuses[k] = shard(posts, {k % 2, 2}); });
    for (std::thread& thread : threads) thread.join();
    for (const absl::Status& status : statuses) EXPECT_TRUE(status.ok()) << status;
    ASSERT_TRUE(merge(posts).ok());
    EXPECT_TRUE(contents(out()) == expected);
    EXPECT_EQ(folder_.files(), (std::vector<std::string>{"out.eyt", "whole.eyt"}));
}

/// Out of core a shard has one scratch: it is done once, or once more when it is whole.
TEST_F(TerrainShards, MayBeDoneTwiceAtTheSameTimeOutOfCore) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 700, 600, 1);
    const std::string expected = whole(posts);
    std::vector<std::thread> threads;
    std::array<absl::Status, 8> statuses;
    for (std::uint32_t k = 0; k < 8; ++k)
        threads.emplace_back([&, k] {
            statuses[k] = shard(posts, {k % 2, 2}, {.memoryBytes = 1});
        });
    for (std::thread& thread : threads) thread.join();
    for (const absl::Status& status : statuses)
        EXPECT_TRUE(status.ok() || absl::IsFailedPrecondition(status)) << status;
    ASSERT_TRUE(merge(posts).ok());
    EXPECT_TRUE(contents(out()) == expected);
    EXPECT_EQ(folder_.files(), (std::vector<std::string>{"out.eyt", "whole.eyt"}));
}

TEST_F(TerrainShards, DoNotMindOneThatFailsAtOnce) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 600, 40, 1);
    const std::vector<std::string> none = {folder_.path("none.tif")};
    ImportControl control;
    control.progress = [&](std::string_view stage, double) {
        if (stage == "reading") {
            EXPECT_FALSE(importTerrainShard(none, out(), {1, 2}, {}, {}).ok());
        }
    };
    const absl::Status status = shard(posts, {0, 2}, {}, control);
    EXPECT_TRUE(status.ok()) << status;
}

TEST_F(TerrainShards, RefuseAFolderAsOutputBeforeTheWork) {
    std::filesystem::create_directory(out());
    const absl::Status status = shard(test::hardGrid(GridKind::Smooth, 20, 20, 1), {0, 2});
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(status.ToString(), HasSubstr(out()));
    EXPECT_FALSE(std::filesystem::exists(partsFolder(out())));
}

/// Each looks for what killed writers have left, and must not be stopped by another that does.
TEST_F(TerrainShards, FilesOfSeveralWritersAreMadeAtTheSameTime) {
    std::vector<std::thread> threads;
    std::array<int, 4> failures{};
    for (int& failed : failures)
        threads.emplace_back([&] {
            for (int i = 0; i < 300; ++i) failed += WholeFile::create(out()).ok() ? 0 : 1;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(failures, testing::Each(0));
    EXPECT_EQ(folder_.files(), std::vector<std::string>{});
}

/// Of facts, unlike of parts, a new one costs little: no file of facts is an error.
TEST_F(TerrainShards, LookAgainWhereFactsAreDamagedOrOfOtherSources) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Noise, 30, 1200, 1);
    const std::string expected = whole(posts);
    terrain::HeightGrid other = posts;
    for (float& h : other.heights) h += 5000;
    GridHeightSource others(other);
    ASSERT_TRUE(importTerrainShard(others, source(8), out(), {0, 3}, {}, {}).ok());
    std::fstream facts(factsPath(out(), {1, 3}), std::ios::in | std::ios::out | std::ios::binary);
    facts.seekp(120);
    facts.put('\x5a');
    facts.close();
    ASSERT_TRUE(sharded(posts, 3).ok());
    EXPECT_TRUE(contents(out()) == expected);
}

class Merging : public TerrainShards {
protected:
    void SetUp() override {
        for (std::uint32_t k = 0; k < 3; ++k) ASSERT_TRUE(shard(posts_, {k, 3}).ok());
    }

    terrain::HeightGrid posts_ = test::hardGrid(GridKind::Smooth, 1100, 24, 1);
};

TEST_F(Merging, NamesAllShardsThatAreMissing) {
    std::filesystem::remove(part(0, 3));
    std::filesystem::remove(part(2, 3));
    const absl::Status status = merge(posts_);
    EXPECT_TRUE(absl::IsNotFound(status)) << status;
    EXPECT_THAT(status.ToString(), AllOf(HasSubstr("0/3, 2/3"), HasSubstr("out.eyt.parts")));
    std::filesystem::remove_all(partsFolder(out()));
    EXPECT_TRUE(absl::IsNotFound(merge(posts_)));
}

TEST_F(Merging, SaysThatTheOutputIsThereWhereThePartsAreGone) {
    ASSERT_TRUE(merge(posts_).ok());
    const absl::Status again = merge(posts_);
    EXPECT_TRUE(absl::IsNotFound(again)) << again;
    EXPECT_THAT(again.ToString(), HasSubstr(out() + " is there, made of these sources"));
    EXPECT_THAT(merge(posts_, kMerge, 8).ToString(), testing::Not(HasSubstr("these sources")));
}

TEST_F(Merging, RefusesPartsOfOtherSourcesAndOptionsAndSaysWhatDiffers) {
    const auto refused = [&](const absl::Status& status, const char* what) {
        EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
        EXPECT_THAT(status.ToString(), AllOf(HasSubstr("shard-0-of-3"), HasSubstr(what)));
    };
    refused(merge(posts_, kMerge, 8), "or the same in another order: their checksum was 0");
    refused(merge(posts_, {.errorMetres = 3}), "no --error, now it is --error 3");
    terrain::HeightGrid moved = posts_;
    moved.origin.x += 1;
    refused(merge(moved), "stand elsewhere");
    refused(merge(test::hardGrid(GridKind::Smooth, 1100, 25, 1)), "1100 x 24 posts");
    EXPECT_TRUE(std::filesystem::exists(part(0, 3)));
    EXPECT_FALSE(std::filesystem::exists(out()));
    EXPECT_TRUE(merge(posts_).ok());
}

/// What the order of pictures is decides which of them is seen.
TEST_F(Merging, TellsThatThePicturesMayBeTheSameInAnotherOrder) {
    const PartIdentity found = identityOf(posts_.frame(), 7, -1, 1, 3);
    EXPECT_THAT(difference(found, identityOf(posts_.frame(), 7, -1, 2, 3)),
                HasSubstr("other pictures, or the same in another order"));
}

TEST_F(Merging, RefusesPartsOfAnotherVersion) {
    PartIdentity other = identityOf(posts_.frame(), 7, -1, 0, 3);
    other.programVersion = {'9', '.', '9'};
    auto writer = PartWriter::create(part(1, 3), other, {1, 3}, {});
    ASSERT_TRUE(writer.ok() && writer->commit().ok());
    const absl::Status status = merge(posts_);
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(status.ToString(),
                AllOf(HasSubstr("shard-1-of-3"), HasSubstr("made by eyrie 9.9, this is")));
}

TEST_F(Merging, RefusesPartsOfTwoSplits) {
    ASSERT_TRUE(shard(posts_, {0, 2}).ok());
    const absl::Status status = merge(posts_);
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(status.ToString(), HasSubstr("one of 2 and one of 3"));
}

TEST_F(Merging, RefusesAPartUnderAnothersName) {
    std::filesystem::copy_file(part(0, 3), part(1, 3),
                               std::filesystem::copy_options::overwrite_existing);
    const absl::Status status = merge(posts_);
    EXPECT_TRUE(absl::IsDataLoss(status)) << status;
    EXPECT_THAT(status.ToString(), AllOf(HasSubstr("shard-1-of-3"), HasSubstr("--shard 1/3")));
}

/// Cut or flipped anywhere, a part is named, nothing is written, and it can be made again.
TEST_F(Merging, NamesADamagedPart) {
    const std::string made = contents(part(1, 3));
    const auto check = [&](const std::string& bytes, std::size_t place) {
        std::ofstream(part(1, 3), std::ios::binary) << bytes;
        const absl::Status status = merge(posts_);
        EXPECT_TRUE(absl::IsDataLoss(status) || absl::IsInvalidArgument(status)) << place << status;
        EXPECT_THAT(status.ToString(), HasSubstr("shard-1-of-3")) << place;
        EXPECT_FALSE(std::filesystem::exists(out())) << place;
    };
    test::Random random(3);
    for (int k = 0; k < 40; ++k) {
        const auto place = static_cast<std::size_t>(
            k < 20 ? random.integer(0, 200)
                   : random.integer(0, static_cast<std::int32_t>(made.size()) - 1));
        std::string flipped = made;
        flipped[place] = static_cast<char>(flipped[place] ^ 0x10);
        check(flipped, place);
        check(made.substr(0, place), place);
    }
    check(made + "x", made.size());
    ASSERT_TRUE(shard(posts_, {1, 3}).ok());
    EXPECT_TRUE(merge(posts_).ok());
}

TEST_F(Merging, SaysWhatItLeavesOfOtherSplits) {
    for (const char* name : {"facts-1-of-5", "shard-1-of-5.scratch"})
        std::ofstream(partsFolder(out()) + "/" + name) << "of another split";
    GridHeightSource posts(posts_);
    const auto report = importTerrain(posts, source(), out(), kMerge, {});
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_THAT(report->notes,
                testing::Contains(HasSubstr("out.eyt.parts: still has facts-1-of-5 and 1 more")));
}

TEST_F(Merging, LeavesThePartsWhenItIsCalledOff) {
    std::stop_source stop;
    ImportControl control;
    control.stop = stop.get_token();
    control.progress = [&](std::string_view stage, double) {
        if (stage == "building")
            stop.request_stop();
    };
    GridHeightSource posts(posts_);
    EXPECT_TRUE(absl::IsCancelled(importTerrain(posts, source(), out(), kMerge, control).status()));
    EXPECT_FALSE(std::filesystem::exists(out()));
    EXPECT_TRUE(merge(posts_).ok());
}

TEST_F(TerrainShards, SayWhichShardsThereAre) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 20, 20, 1);
    for (const Shard wrong : {Shard{0, 0}, Shard{3, 3}, Shard{7, 3}, Shard{0, kMaxShards + 1}})
        EXPECT_TRUE(absl::IsInvalidArgument(shard(posts, wrong)))
            << wrong.index << "/" << wrong.count;
    EXPECT_TRUE(folder_.files().empty());
}

TEST_F(TerrainShards, SayWhenThereIsNoDataAtAll) {
    terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 20, 600, 1);
    for (float& h : posts.heights) h = terrain::kNodata;
    const absl::Status status = shard(posts, {0, 2});
    EXPECT_TRUE(absl::IsInvalidArgument(status));
    EXPECT_THAT(status.ToString(), HasSubstr("all posts are nodata"));
}

TEST_F(TerrainShards, LeaveNoPartWhenTheDiskIsFull) {
    const terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 900, 600, 1);
    const std::string expected = whole(posts);
    {
        const test::FileSizeLimit limit(200'000);
        const absl::Status status = shard(posts, {0, 2});
        EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
        EXPECT_THAT(status.ToString(), HasSubstr("shard-0-of-2"));
    }
    EXPECT_EQ(namesIn(partsFolder(out())), (std::set<std::string>{"facts-0-of-2", "facts-1-of-2"}));
    ASSERT_TRUE(sharded(posts, 2).ok());
    EXPECT_TRUE(contents(out()) == expected);
}

/// A shard whose own posts are all nodata has part in a terrain all the same.
TEST_F(TerrainShards, MayHaveNoDataOfTheirOwn) {
    terrain::HeightGrid posts = test::hardGrid(GridKind::Smooth, 20, 1500, 1);
    std::fill(posts.heights.begin(), posts.heights.begin() + 20 * 1200, terrain::kNodata);
    const std::string expected = whole(posts);
    ASSERT_TRUE(sharded(posts, 3).ok());
    EXPECT_TRUE(contents(out()) == expected);
}

}  // namespace
}  // namespace eyrie::import
