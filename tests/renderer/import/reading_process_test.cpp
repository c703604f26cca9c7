// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/reading_process.h"

#include <csignal>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/renderer/import/ply_text.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

constexpr ReadingLimits kRoomy{1ULL << 30, std::chrono::seconds(60)};

absl::Status statusOf(const std::function<absl::StatusOr<TriangleMesh>()>& read,
                      const ReadingLimits& limits = kRoomy) {
    return readInOwnProcess(read, limits, {}).status();
}

TEST(ReadingProcess, BringsBackAllOfAMesh) {
    TriangleMesh mesh = test::tetrahedron();
    mesh.normals.assign(4, {1, 2, 3});
    mesh.colours.assign(4, {1, 2, 3, 4});
    mesh.droppedFaces = 7;
    mesh.notes = {"first", "second"};
    const auto read = readInOwnProcess([&] { return mesh; }, kRoomy, {});
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(*read, mesh);
}

TEST(ReadingProcess, TakesMemoryForItsPicturesOnce) {
    constexpr std::uint64_t kImages = 12;
    const mesh::ImageShape shape{4096, 4096, 0};
    const auto read = [&] {
        TriangleMesh mesh;
        for (std::uint64_t i = 0; i < kImages; ++i)
            mesh.images.push_back({shape, std::vector<std::byte>(shape.bytesFrom(0))});
        return mesh;
    };
    constexpr std::uint64_t kBeside = 64 << 20;
    const auto mesh = readInOwnProcess(
        read, {kImages * shape.bytesFrom(0) + kBeside, std::chrono::seconds(60)}, {});
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->images.size(), kImages);
}

TEST(ReadingProcess, BringsBackAnError) {
    const absl::Status status = statusOf([] { return absl::NotFoundError("no such thing"); });
    EXPECT_EQ(status, absl::NotFoundError("no such thing"));
}

TEST(ReadingProcess, OutlivesACrash) {
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) {
        const absl::Status status = statusOf([&]() -> absl::StatusOr<TriangleMesh> {
            std::signal(signal, SIG_DFL);
            raise(signal);
            return TriangleMesh();
        });
        EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(status.message()), HasSubstr(std::to_string(signal)));
    }
}

TEST(ReadingProcess, OutlivesAnExitAndAnException) {
    const auto exits = []() -> absl::StatusOr<TriangleMesh> { _exit(0); };
    EXPECT_EQ(statusOf(exits).code(), absl::StatusCode::kInvalidArgument);
    const auto throws = []() -> absl::StatusOr<TriangleMesh> { throw std::runtime_error("odd"); };
    EXPECT_EQ(statusOf(throws).code(), absl::StatusCode::kInvalidArgument);
}

TEST(ReadingProcess, EndsAnEndlessLoop) {
    volatile bool forever = true;
    const auto loops = [&]() -> absl::StatusOr<TriangleMesh> {
        while (forever) {
        }
        return TriangleMesh();
    };
    const absl::Status status = statusOf(loops, {1ULL << 30, std::chrono::seconds(1)});
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(status.message()), HasSubstr("1 s"));
}

TEST(ReadingProcess, EndsWhatTakesAllMemory) {
    const auto hoards = []() -> absl::StatusOr<TriangleMesh> {
        std::vector<std::vector<char>> hoard;
        while (true) hoard.emplace_back(16 << 20, 'x');
    };
    // A sanitizer ends the process where memory runs out, which looks like a crash.
    EXPECT_THAT(
        statusOf(hoards, {256 << 20, std::chrono::seconds(60)}).code(),
        testing::AnyOf(absl::StatusCode::kResourceExhausted, absl::StatusCode::kInvalidArgument));
}

TEST(ReadingProcess, IsCalledOff) {
    std::stop_source stop;
    const auto waits = []() -> absl::StatusOr<TriangleMesh> {
        while (true) pause();
    };
    std::jthread caller([&] { stop.request_stop(); });
    EXPECT_EQ(readInOwnProcess(waits, kRoomy, {{}, stop.get_token()}).status().code(),
              absl::StatusCode::kCancelled);
}

TEST(ReadingLimits, GrowWithTheFile) {
    EXPECT_GE(ReadingLimits::forFile(0).memoryBytes, 1ULL << 30);
    EXPECT_GE(ReadingLimits::forFile(1ULL << 30).memoryBytes, 64ULL << 30);
    EXPECT_GT(ReadingLimits::forFile(~0ULL).memoryBytes, 64ULL << 30);
}

TEST(ReadingLimits, HaveRoomForEveryTexture) {
    const mesh::ImageShape largest{mesh::kMaxImageSide, mesh::kMaxImageSide, mesh::kHasAlpha};
    EXPECT_GE(ReadingLimits::forTextures(100).memoryBytes,
              (1ULL << 30) + 100 * largest.bytesFrom(0));
}

}  // namespace
}  // namespace eyrie::import
