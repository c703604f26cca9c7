// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/whole_file.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fabric/partial_file.h"
#include "tests/renderer/import/file_size_limit.h"
#include "tests/renderer/import/terrain_fixture.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text));
}

TEST(WholeFile, IsThereOnlyOnceItIsCommitted) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("a");
    {
        auto file = WholeFile::create(path);
        ASSERT_TRUE(file.ok()) << file.status();
        ASSERT_TRUE(file->append(bytesOf("xxcd")).ok());
        ASSERT_TRUE(file->writeAt(0, bytesOf("ab")).ok());
        EXPECT_EQ(file->sizeBytes(), 4U);
        EXPECT_FALSE(std::filesystem::exists(path));
        ASSERT_TRUE(file->commit().ok());
    }
    EXPECT_EQ(test::contents(path), "abcd");
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a"});
    { ASSERT_TRUE(WholeFile::create(path)->append(bytesOf("never")).ok()); }
    EXPECT_EQ(test::contents(path), "abcd");
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a"});
}

TEST(WholeFile, MayBeWrittenByTwoAtOnce) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("a");
    auto first = WholeFile::create(path);
    auto second = WholeFile::create(path);
    ASSERT_TRUE(first.ok() && second.ok());
    ASSERT_TRUE(first->append(bytesOf("first")).ok());
    ASSERT_TRUE(second->append(bytesOf("second")).ok());
    ASSERT_TRUE(first->commit().ok());
    EXPECT_EQ(test::contents(path), "first");
    ASSERT_TRUE(second->commit().ok());
    EXPECT_EQ(test::contents(path), "second");
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a"});
}

TEST(WholeFile, RemovesWhatAKilledWriterLeftAndNothingElse) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path("a.partial-0123456789abcdef")) << "half";
    std::ofstream(folder.path("b.partial-0123456789abcdef")) << "another's";
    auto living = WholeFile::create(folder.path("a"));
    ASSERT_TRUE(living.ok());
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.partial-0123456789abcdef")));
    fabric::removeAbandoned(folder.path("a"));
    EXPECT_TRUE(living->commit().ok());
    EXPECT_TRUE(std::filesystem::exists(folder.path("b.partial-0123456789abcdef")));
}

TEST(WholeFile, SaysWhatIsWrongWithItsFolder) {
    const auto file = WholeFile::create("/none/such/a");
    EXPECT_EQ(file.status().code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(file.status().ToString(), HasSubstr("/none/such/a"));
}

TEST(WholeFile, SaysThatTheDiskIsFull) {
    const test::TemporaryFolder folder;
    {
        auto file = WholeFile::create(folder.path("a"));
        ASSERT_TRUE(file.ok()) << file.status();
        const test::FileSizeLimit limit(1000);
        ASSERT_TRUE(file->append(bytesOf(std::string(1000, 'x'))).ok());
        const absl::Status status = file->append(bytesOf("x"));
        EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
        EXPECT_THAT(status.ToString(), HasSubstr(folder.path("a")));
    }
    EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace eyrie::import
