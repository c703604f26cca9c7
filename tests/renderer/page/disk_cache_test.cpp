// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/disk_cache.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fabric/log.h"
#include "tests/support/captured_log.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::page {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPart = 1000;

std::vector<std::byte> part(int number, std::size_t bytes = kPart) {
    return std::vector<std::byte>(bytes, static_cast<std::byte>(number));
}

CacheKey key(int number) { return {"group", fmt::format("part-{}", number)}; }

bool has(const DiskCache& cache, int number) {
    std::vector<std::byte> found(kPart);
    return cache.find(key(number), found) && found == part(number);
}

std::uint64_t bytesIn(const fs::path& folder) {
    std::uint64_t sum = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().filename() != "lock")
            sum += entry.file_size();
    return sum;
}

class DiskCacheTest : public testing::Test {
protected:
    void makeOld(int number, int minutes) const {
        fs::last_write_time(folder() / "group" / fmt::format("part-{}", number),
                            fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
    }
    fs::path folder() const { return temporary_.path() / "cache"; }

    test::TemporaryFolder temporary_;
};

TEST_F(DiskCacheTest, FindsWhatWasStoredAlsoInTheNextRun) {
    DiskCache(folder(), 1 << 20).store(key(1), part(1));
    const DiskCache next(folder(), 1 << 20);
    EXPECT_TRUE(has(next, 1));
    EXPECT_FALSE(has(next, 2));
    std::vector<std::byte> longer(kPart + 1);
    EXPECT_FALSE(next.find(key(1), longer)) << "a part of another size is not this part";
}

TEST_F(DiskCacheTest, NeverExceedsItsLimitAndDropsWhatWasNotUsedLongest) {
    DiskCache cache(folder(), 10 * kPart);
    for (int i = 0; i < 10; ++i) {
        cache.store(key(i), part(i));
        makeOld(i, 100 - i);
    }
    EXPECT_TRUE(has(cache, 0)) << "which makes it the most recently used";
    for (int i = 10; i < 40; ++i) {
        cache.store(key(i), part(i));
        EXPECT_LE(bytesIn(folder()), cache.limitBytes());
        if (i == 10) {
            EXPECT_TRUE(has(cache, 0));
            EXPECT_FALSE(has(cache, 1)) << "the oldest";
        }
        EXPECT_TRUE(has(cache, i));
        makeOld(i, 50 - i);
    }
    EXPECT_GE(bytesIn(folder()), cache.limitBytes() / 2) << "it should use what it may";
}

TEST_F(DiskCacheTest, StoresNothingLargerThanItsLimit) {
    DiskCache cache(folder(), kPart - 1);
    cache.store(key(1), part(1));
    EXPECT_FALSE(has(cache, 1));
    EXPECT_EQ(bytesIn(folder()), 0U);
}

TEST_F(DiskCacheTest, CountsAReplacedPartOnce) {
    DiskCache cache(folder(), 3 * kPart);
    cache.store(key(2), part(2));
    for (int i = 0; i < 20; ++i) cache.store(key(1), part(1));
    EXPECT_TRUE(has(cache, 1));
    EXPECT_TRUE(has(cache, 2)) << "there was room for both";
}

TEST_F(DiskCacheTest, DropsAPartOrAGroup) {
    DiskCache cache(folder(), 1 << 20);
    cache.store(key(1), part(1));
    cache.store(key(2), part(2));
    cache.store({"other", "part"}, part(3));
    cache.drop(key(1));
    EXPECT_FALSE(has(cache, 1));
    EXPECT_TRUE(has(cache, 2));
    cache.dropGroup("group");
    EXPECT_FALSE(has(cache, 2));
    EXPECT_EQ(cache.sizeOf({"other", "part"}), kPart);
}

TEST_F(DiskCacheTest, HoldsItsLimitForAllProcessesTogetherAndLosesNoPart) {
    constexpr int kProcesses = 4;
    constexpr int kParts = 60;
    const std::uint64_t limit = 25 * kPart;
    std::vector<pid_t> children;
    for (int process = 0; process < kProcesses; ++process) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            DiskCache cache(folder(), limit);
            bool isWhole = true;
            for (int i = 0; i < kParts; ++i) {
                cache.store(key((process * 7 + i) % 50), part((process * 7 + i) % 50));
                std::vector<std::byte> found(kPart);
                for (int other = 0; other < 50; ++other)
                    if (cache.find(key(other), found) && found != part(other))
                        isWhole = false;
            }
            _exit(isWhole ? 0 : 1);
        }
        children.push_back(child);
    }
    for (std::size_t ended = 0; ended < children.size();) {
        int status = 0;
        if (waitpid(children[ended], &status, WNOHANG) == children[ended]) {
            EXPECT_EQ(status, 0) << "a part was not what had been stored";
            ++ended;
        }
        std::uint64_t sum = 0;
        std::error_code gone;
        for (fs::recursive_directory_iterator it(folder(), gone), end; !gone && it != end;
             it.increment(gone))
            if (it->path().filename() != "lock" && it->path().filename() != "partial")
                if (const auto bytes = it->file_size(gone); !gone)
                    sum += bytes;
        // Files may go and come while they are counted: one that is replaced counts twice, at most.
        EXPECT_LE(sum, limit + kProcesses * kPart);
    }
    EXPECT_LE(bytesIn(folder()), limit);
}

TEST_F(DiskCacheTest, RemovesWhatAKilledWriterLeft) {
    DiskCache(folder(), 1 << 20).store(key(1), part(1));
    std::ofstream(folder() / "partial") << "half a pa";
    DiskCache cache(folder(), 1 << 20);
    cache.store(key(2), part(2));
    EXPECT_EQ(bytesIn(folder()), 2 * kPart);
    EXPECT_TRUE(has(cache, 1));
}

TEST_F(DiskCacheTest, AFolderThatCannotBeWrittenIsNoErrorAndSaidOnce) {
    const test::CapturedLog log;
    const std::string file = temporary_.write("file", "no folder");
    DiskCache cache(fs::path(file) / "cache", 1 << 20);
    for (int i = 0; i < 5; ++i) cache.store(key(i), part(i));
    EXPECT_FALSE(has(cache, 1));
    EXPECT_EQ(log.lines(), 1);
}

TEST_F(DiskCacheTest, AFullDiskIsNoErrorAndLeavesNoHalfOfAPart) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {  // no file of this process may be larger than half a part
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{kPart / 2, kPart / 2};
        setrlimit(RLIMIT_FSIZE, &limit);
        const test::CapturedLog log;
        DiskCache cache(folder(), 1 << 20);
        for (int i = 0; i < 5; ++i) cache.store(key(i), part(i));
        _exit(log.lines() == 1 && bytesIn(folder()) == 0 ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace eyrie::page
