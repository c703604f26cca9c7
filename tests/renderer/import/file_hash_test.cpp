// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/file_hash.h"

#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "renderer/import/geotiff_writer.h"
#include "renderer/import/shard_part.h"
#include "renderer/import/terrain_shard.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/support/page_server.h"

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLarge = 17 << 20;

/// What this process has read of files so far.
std::uint64_t bytesRead() {
    std::ifstream in("/proc/self/io");
    std::string name;
    std::uint64_t bytes = 0;
    in >> name >> bytes;  // rchar, the first
    return bytes;
}

/// Until a change of the file would have another time than the last one.
void waitForTheClockOf(const std::string& path) {
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    const std::array changed{status.st_ctim.tv_sec, status.st_ctim.tv_nsec};
    timespec now{};
    do clock_gettime(CLOCK_REALTIME_COARSE, &now);
    while (std::array{now.tv_sec, now.tv_nsec} <= changed);
}

class FileHash : public testing::Test {
protected:
    FileHash() {
        fs::create_directory(notes_);
        std::ofstream(path_, std::ios::binary) << std::string(kLarge, 'a');
        waitForTheClockOf(path_);
    }

    std::uint64_t hash(const std::string& folder) const {
        const absl::StatusOr<std::uint64_t> hash = fileHash(path_, folder);
        EXPECT_TRUE(hash.ok()) << hash.status();
        return hash.value_or(0);
    }
    std::uint64_t hashed() const { return hash(notes_); }
    /// Bytes that hashing it takes.
    std::uint64_t readFor() const {
        const std::uint64_t before = bytesRead();
        static_cast<void>(hashed());
        return bytesRead() - before;
    }
    std::size_t notesKept() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(notes_), fs::directory_iterator()));
    }

    test::TemporaryFolder folder_;
    std::string path_ = folder_.path("file");
    std::string notes_ = folder_.path("notes");
};

TEST_F(FileHash, OfALargeFileIsReadOnceByAllWhoShareAFolder) {
    const std::uint64_t expected = hash("");
    EXPECT_EQ(notesKept(), 0U);
    EXPECT_GE(readFor(), kLarge);
    EXPECT_LT(readFor(), kLarge / 100);
    EXPECT_EQ(hashed(), expected);
    EXPECT_EQ(notesKept(), 1U);
    removeNotedHashes(notes_);
    EXPECT_EQ(notesKept(), 0U);
    EXPECT_GE(readFor(), kLarge);
}

TEST_F(FileHash, IsReadAgainWhenTheFileHasChangedThoughItsSizeAndTimeHaveNot) {
    const std::uint64_t before = hashed();
    const fs::file_time_type time = fs::last_write_time(path_);
    {
        std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(kLarge / 2);
        file.put('b');
    }
    fs::last_write_time(path_, time);
    EXPECT_NE(hashed(), before);
    EXPECT_EQ(hashed(), hash(""));
}

TEST_F(FileHash, IsReadAgainWhereItsNoteIsDamaged) {
    const std::uint64_t expected = hashed();
    ASSERT_EQ(notesKept(), 1U);
    const fs::path note = fs::directory_iterator(notes_)->path();
    for (const std::uintmax_t at : {0U, 20U, 60U}) {
        {
            std::fstream file(note, std::ios::in | std::ios::out | std::ios::binary);
            file.seekp(static_cast<std::streamoff>(at));
            file.put('\x5a');
        }
        EXPECT_EQ(hashed(), expected) << at;
        EXPECT_LT(readFor(), kLarge / 100) << "noted again";
    }
    fs::resize_file(note, 30);
    EXPECT_EQ(hashed(), expected);
}

TEST_F(FileHash, IsTheSameForManyAtOnce) {
    const std::uint64_t expected = hash("");
    std::array<std::uint64_t, 6> found{};
    {
        std::vector<std::jthread> threads;
        for (std::uint64_t& one : found)
            threads.emplace_back([&one, this] { one = fileHash(path_, notes_).value_or(0); });
    }
    EXPECT_THAT(found, testing::Each(expected));
    EXPECT_EQ(notesKept(), 1U);
}

TEST_F(FileHash, LeavesNoNoteOfASmallFileNorWhereItCannot) {
    fs::resize_file(path_, 1000);
    const std::uint64_t expected = hash("");
    EXPECT_EQ(hashed(), expected);
    EXPECT_EQ(notesKept(), 0U);
    fs::resize_file(path_, kLarge);
    EXPECT_EQ(hash(folder_.path("none")), hash(""));
    EXPECT_TRUE(absl::IsNotFound(fileHash(folder_.path("no.tif"), notes_).status()));
}

TEST_F(FileHash, IsCalledOffWithoutANote) {
    std::stop_source stop;
    const std::uint64_t before = bytesRead();
    stop.request_stop();
    EXPECT_TRUE(absl::IsCancelled(fileHash(path_, notes_, stop.get_token()).status()));
    noteHash(path_, notes_, stop.get_token());
    EXPECT_LT(bytesRead() - before, kLarge);
    EXPECT_EQ(notesKept(), 0U);
    EXPECT_EQ(hashed(), hash(""));
    EXPECT_TRUE(fileHash(path_, notes_, stop.get_token()).ok()) << "known";
}

TEST_F(FileHash, IsNotOfAPartOfWhatAServerHas) {
    test::PageServer server(std::string(1 << 20, 'a'));
    const std::string name = "/vsicurl/" + server.url("dem.xyz");
    server.refuseOnce(700'000);
    const absl::Status status = fileHash(name, "").status();
    EXPECT_TRUE(absl::IsUnavailable(status)) << status;
    EXPECT_THAT(status.ToString(), testing::HasSubstr("of its 1048576 bytes came"));
}

/// A strip of 17 MB, most of which one of two shards has.
TEST(TerrainShardHashes, AreNotedOnceForAllShardsAndGoWithTheirParts) {
    const test::TemporaryFolder folder;
    const std::string dem = folder.path("dem.tif");
    const std::string out = folder.path("out.eyt");
    constexpr std::int32_t kColumns = 8800;
    constexpr std::int32_t kRows = 500;
    terrain::HeightGrid grid{.columns = kColumns, .rows = kRows, .heights = {}};
    grid.heights.assign(std::size_t{kColumns} * kRows, 5.0F);
    ASSERT_TRUE(writeGeoTiff(grid, dem).ok());
    waitForTheClockOf(dem);
    const auto notes = [&] {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(partsFolder(out)))
            if (entry.path().filename().string().starts_with("hash-"))
                names.push_back(entry.path().filename().string());
        return names;
    };
    ASSERT_TRUE(importTerrainShard({dem}, out, {0, 2}, {}, {}).ok());
    const std::vector<std::string> first = notes();
    EXPECT_EQ(first.size(), 1U);
    ASSERT_TRUE(importTerrainShard({dem}, out, {1, 2}, {}, {}).ok());
    EXPECT_EQ(notes(), first);
    ASSERT_TRUE(importTerrain({dem}, out, {.mergesParts = true}, {}).ok());
    EXPECT_FALSE(fs::exists(partsFolder(out)));
    ASSERT_TRUE(importTerrain({dem}, folder.path("whole.eyt"), {}, {}).ok());
    EXPECT_TRUE(test::contents(out) == test::contents(folder.path("whole.eyt")));
    EXPECT_FALSE(importTerrainShard({folder.path("no.tif")}, out, {0, 2}, {}, {}).ok());
    EXPECT_FALSE(fs::exists(partsFolder(out))) << "of a shard that could not begin";
}

}  // namespace
}  // namespace eyrie::import
