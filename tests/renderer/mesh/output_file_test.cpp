// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/output_file.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fabric/partial_file.h"
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

TEST(OutputFile, IsRefusedBeforeTheWorkWhenItsNameIsAFolder) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("out"));
    EXPECT_TRUE(absl::IsInvalidArgument(OutputFile::check(folder.file("out"))));
    EXPECT_TRUE(absl::IsInvalidArgument(OutputFile::create(folder.file("out")).status()));
    EXPECT_THAT(folder.names(), testing::ElementsAre("out"));
}

TEST(OutputFile, LeavesNothingWhenItsNameHasBecomeAFolder) {
    const test::TemporaryFolder folder;
    {
        auto out = OutputFile::create(folder.file("out"));
        ASSERT_TRUE(out.ok());
        std::filesystem::create_directory(folder.file("out"));
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

/// What a pipe's reader gets until nobody writes to it any more.
std::string drained(int fd) {
    std::string text;
    std::array<char, 64> buffer{};
    for (ssize_t got = 0; (got = ::read(fd, buffer.data(), buffer.size())) > 0;)
        text.append(buffer.data(), static_cast<std::size_t>(got));
    return text;
}

TEST(OutputFile, WritesToAPipeAndLeavesItThere) {
    const test::TemporaryFolder folder;
    const std::string pipe = folder.file("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    ASSERT_TRUE(OutputFile::check(pipe).ok());  // would wait for a reader if it opened it
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    auto out = OutputFile::create(pipe);
    ASSERT_TRUE(out.ok()) << out.status();
    ASSERT_TRUE(out->write(bytesOf("bytes")).ok());
    EXPECT_EQ(out->writeAt(0, bytesOf("b")).code(), absl::StatusCode::kInvalidArgument);
    ASSERT_TRUE(out->commit().ok());
    EXPECT_EQ(drained(reader), "bytes");
    ::close(reader);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    EXPECT_THAT(folder.names(), testing::ElementsAre("pipe"));
}

/// How much of what was written to a pipe nobody has read.
int unread(int fd) {
    int bytes = 0;
    EXPECT_EQ(::ioctl(fd, FIONREAD, &bytes), 0);
    return bytes;
}

TEST(OutputFile, StopsWaitingForWhoDoesNotReadOnFromAPipe) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    const int reader = ::open(folder.file("pipe").c_str(), O_RDONLY | O_NONBLOCK);
    const int room = ::fcntl(reader, F_GETPIPE_SZ);
    std::stop_source stop;
    auto out = OutputFile::create(folder.file("pipe"), stop.get_token());
    ASSERT_TRUE(out.ok()) << out.status();
    const std::jthread stopping([&] {
        while (unread(reader) < room) std::this_thread::yield();
        stop.request_stop();
    });
    const std::vector<std::byte> bytes(static_cast<std::size_t>(room) + 1);
    EXPECT_EQ(out->write(bytes).code(), absl::StatusCode::kCancelled);
    ::close(reader);
}

TEST(OutputFile, LeavesADeviceWhereItIsBehindALink) {
    const test::TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/null", folder.file("nothing"));
    auto out = OutputFile::create(folder.file("nothing"));
    ASSERT_TRUE(out.ok()) << out.status();
    EXPECT_TRUE(out->write(bytesOf("bytes")).ok());
    EXPECT_TRUE(out->commit().ok());
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("nothing")));
    EXPECT_TRUE(std::filesystem::is_character_file(folder.file("nothing")));
}

TEST(OutputFile, GoesOnWhereStandardOutputIsThoughThatIsAFile) {
    const test::TemporaryFolder folder;
    const std::string whole = folder.file("whole");
    std::filesystem::create_symlink("/proc/self/fd/1", folder.file("stdout"));
    std::fflush(stdout);
    const int before = ::dup(STDOUT_FILENO);
    const int file = ::open(whole.c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(file, STDOUT_FILENO);
    EXPECT_EQ(::write(STDOUT_FILENO, "first ", 6), 6);
    {
        auto out = OutputFile::create(folder.file("stdout"));
        EXPECT_TRUE(out.ok() && out->write(bytesOf("second ")).ok() && out->commit().ok());
    }
    EXPECT_EQ(::write(STDOUT_FILENO, "third", 5), 5);
    ::dup2(before, STDOUT_FILENO);
    ::close(before);
    ::close(file);
    EXPECT_EQ(test::readFile(whole), "first second third");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("stdout")));
}

TEST(OutputFile, TouchesNothingThroughALinkOfAPartialFilesName) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("else"), "precious");
    std::filesystem::create_symlink(folder.file("else"),
                                    folder.file("out.partial-0123456789abcdef"));
    auto out = OutputFile::create(folder.file("out"));
    ASSERT_TRUE(out.ok() && out->write(bytesOf("new")).ok() && out->commit().ok());
    EXPECT_EQ(test::readFile(folder.file("else")), "precious");
}

TEST(OutputFile, HasItsOwnPartialFileWhereAnotherWritesTheSame) {
    const test::TemporaryFolder folder;
    auto first = OutputFile::create(folder.file("out"));
    auto second = OutputFile::create(folder.file("out"));
    ASSERT_TRUE(first.ok() && second.ok());
    ASSERT_TRUE(first->write(bytesOf("first")).ok() && second->write(bytesOf("second")).ok());
    ASSERT_TRUE(first->commit().ok());
    EXPECT_EQ(test::readFile(folder.file("out")), "first");
    ASSERT_TRUE(second->commit().ok());
    EXPECT_EQ(test::readFile(folder.file("out")), "second");
}

TEST(OutputFile, RemovesWhatAKilledWriterOfTheSameLeft) {
    const test::TemporaryFolder folder;
    for (const char* name : {"out.partial-0123456789abcdef", "other.partial-0123456789abcdef"})
        test::writeFile(folder.file(name), "half");
    ASSERT_TRUE(OutputFile::create(folder.file("out")).ok());
    EXPECT_FALSE(std::filesystem::exists(folder.file("out.partial-0123456789abcdef")));
    EXPECT_TRUE(std::filesystem::exists(folder.file("other.partial-0123456789abcdef")));
}

TEST(OutputFile, MayHaveTheLongestName) {
    const test::TemporaryFolder folder;
    const std::string name = std::string(250, 'a');
    for (const char* end : {".eym1", ".eym2"}) {  // alike but for the end
        auto killed = fabric::createPartial(folder.file(name + end));
        ASSERT_TRUE(killed.ok()) << killed.status();
        ::close(killed->fd);
    }
    auto out = OutputFile::create(folder.file(name + ".eym1"));
    ASSERT_TRUE(out.ok()) << out.status();
    ASSERT_TRUE(out->write(bytesOf("new")).ok() && out->commit().ok());
    EXPECT_EQ(test::readFile(folder.file(name + ".eym1")), "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("")), {}), 2)
        << "itself, and what a writer of the other left";
    EXPECT_TRUE(OutputFile::createUnnamed(folder.file(name + ".eym1")).ok());
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
