// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/output_file.h"

#include <filesystem>
#include <span>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "renderer/mesh/mapped_file.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::mesh {
namespace {

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text));
}

TEST(OutputFile, AppearsWithAllItsBytesOnCommitOnly) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("out"), "old");
    {
        auto out = OutputFile::create(folder.file("out"));
        ASSERT_TRUE(out.ok()) << out.status();
        ASSERT_TRUE(out->write(bytesOf("new!!")).ok());
        ASSERT_TRUE(out->padTo(4).ok());
        EXPECT_EQ(test::readFile(folder.file("out")), "old");
        ASSERT_TRUE(out->commit().ok());
    }
    EXPECT_EQ(test::readFile(folder.file("out")), std::string("new!!\0\0\0", 8));
    EXPECT_THAT(folder.names(), testing::ElementsAre("out"));
}

TEST(OutputFile, LeavesNothingWithoutCommit) {
    const test::TemporaryFolder folder;
    {
        auto out = OutputFile::create(folder.file("out"));
        ASSERT_TRUE(out.ok());
        ASSERT_TRUE(out->write(bytesOf("half")).ok());
        EXPECT_EQ(folder.names().size(), 1U);
    }
    EXPECT_THAT(folder.names(), testing::IsEmpty());
}

TEST(OutputFile, LeavesNothingWhenItsNameIsAFolder) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("out"));
    {
        auto out = OutputFile::create(folder.file("out"));
        ASSERT_TRUE(out.ok());
        EXPECT_FALSE(out->commit().ok());
    }
    EXPECT_THAT(folder.names(), testing::ElementsAre("out"));
}

TEST(OutputFile, NamesTheMissingFolder) {
    const auto out = OutputFile::create("/nowhere/at/all/mesh.eym");
    EXPECT_EQ(out.status().code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(std::string(out.status().message()),
                testing::HasSubstr("/nowhere/at/all/mesh.eym"));
}

TEST(MappedFile, RefusesWhatIsNoFileWithoutWaiting) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    EXPECT_EQ(MappedFile::open(folder.file("pipe")).status().code(),
              absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(MappedFile::open(folder.file("")).status().code(),
              absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(MappedFile::open(folder.file("none")).status().code(), absl::StatusCode::kNotFound);
}

TEST(MappedFile, OfAnEmptyFileHasNoBytes) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("empty"), "");
    const auto file = MappedFile::open(folder.file("empty"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_TRUE(file->bytes().empty());
}

}  // namespace
}  // namespace eyrie::mesh
