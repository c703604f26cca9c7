// SPDX-License-Identifier: Apache-2.0
// What imports make of locks that come late, and of file systems that have none.
#include <cerrno>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "fabric/partial_file.h"
#include "renderer/import/import_journal.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "tests/renderer/import/terrain_fixture.h"

namespace eyrie::import {
namespace {

std::function<void()> beforeNextLock;
int lockError = 0;  ///< with which every lock is refused; 0: none is

}  // namespace
}  // namespace eyrie::import

/// In place of the system's, in all of this program.
extern "C" int flock(int fd, int operation) noexcept {
    if (const auto act = std::exchange(eyrie::import::beforeNextLock, nullptr))
        act();
    if (eyrie::import::lockError == 0)
        return static_cast<int>(syscall(SYS_flock, fd, operation));
    errno = eyrie::import::lockError;
    return -1;
}

namespace eyrie::import {
namespace {

class ImportLocks : public testing::TestWithParam<int> {
protected:
    void TearDown() override { lockError = 0; }

    test::TemporaryFolder folder_;
};

/// What was done says nothing then: its scratch is gone.
TEST_F(ImportLocks, OfAJournalThatWasRemovedBeforeAreOfANewOne) {
    const std::string path = folder_.path("journal");
    std::optional<ImportJournal> first;
    {
        auto opened = ImportJournal::open(path, 5, false);
        ASSERT_TRUE(opened.ok()) << opened.status();
        first.emplace(*std::move(opened));
    }
    ASSERT_TRUE(first->add(0, std::vector<std::byte>(10), 0).ok());
    beforeNextLock = [&] {
        first->remove();
        first.reset();
    };
    const auto second = ImportJournal::open(path, 5, false);
    ASSERT_TRUE(second.ok()) << second.status();
    EXPECT_TRUE(second->isEmpty());
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_TRUE(absl::IsFailedPrecondition(ImportJournal::open(path, 5, false).status()));
}

TEST_P(ImportLocks, AreDoneWithoutWhereThereAreNone) {
    const terrain::HeightGrid grid = synthesizeTerrain(800, 4);
    const TerrainImportOptions how = {.memoryBytes = 1};
    lockError = GetParam();
    EXPECT_NE(test::imported(grid, folder_, how), nullptr);
}

TEST_P(ImportLocks, ThatThereAreNotLeaveAFileThatMayBeAnothers) {
    lockError = GetParam();
    const auto partial = fabric::createPartial(folder_.path("a.eyt"));
    ASSERT_TRUE(partial.ok()) << partial.status();
    fabric::removeAbandoned(folder_.path("a.eyt"));
    EXPECT_TRUE(std::filesystem::exists(partial->path));
    close(partial->fd);
}

INSTANTIATE_TEST_SUITE_P(Errors, ImportLocks, testing::Values(ENOLCK, EOPNOTSUPP, ENOSYS));

}  // namespace
}  // namespace eyrie::import
