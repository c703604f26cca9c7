// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/scratch.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include "renderer/terrain/tiled_raster.h"

namespace eyrie::terrain {
namespace {

std::string freshPath() {
    static int count = 0;
    return (std::filesystem::temp_directory_path() /
            ("eyrie-scratch-" + std::to_string(getpid()) + "-" + std::to_string(count++)))
        .string();
}

Scratch::Piece pieceOf(std::size_t bytes, int value) {
    const auto piece = Scratch::newPiece(bytes);
    std::memset(piece.get(), value, bytes);
    return piece;
}

/// Whatever the order of writes and reads, and however little stays in memory.
RC_GTEST_PROP(Scratch, GivesBackWhatWasWrittenLast, ()) {
    constexpr std::size_t kPlaces = 40;
    constexpr std::size_t kBytes = 5000;
    const std::string path = freshPath();
    {
        Scratch scratch(path, *rc::gen::inRange<std::uint64_t>(0, 400000));
        std::vector<std::uint64_t> places;
        for (std::size_t k = 0; k < kPlaces; ++k) places.push_back(scratch.reserve(kBytes));
        std::vector<int> expected(kPlaces, 0);
        for (const auto& [place, value] :
             *rc::gen::container<std::vector<std::pair<std::size_t, int>>>(rc::gen::pair(
                 rc::gen::inRange<std::size_t>(0, kPlaces), rc::gen::inRange(0, 256)))) {
            if (value % 2 == 0) {
                scratch.write(places[place], pieceOf(kBytes, value), kBytes);
                expected[place] = value;
            } else if (expected[place] != 0) {
                RC_ASSERT(std::memcmp(scratch.read(places[place], kBytes).get(),
                                      pieceOf(kBytes, expected[place]).get(), kBytes) == 0);
            }
        }
        RC_ASSERT(scratch.status().ok());
        RC_ASSERT(scratch.flush().ok());
    }
    std::filesystem::remove(path);
}

TEST(Scratch, TouchesNoDiskForWhatFits) {
    const std::string path = freshPath();
    Scratch scratch(path, 1 << 20);
    const std::uint64_t place = scratch.reserve(100000);
    scratch.write(place, pieceOf(100000, 3), 100000);
    EXPECT_EQ(static_cast<int>(scratch.read(place, 100000)[5]), 3);
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Scratch, TakesNoRoomForZerosAndLeavesNothingOfAnothersThere) {
    const std::string path = freshPath();
    for (const bool isAnothers : {true, false}) {
        Scratch scratch(path, 0);
        const std::uint64_t used = scratch.reserve(5000);
        const std::uint64_t unused = scratch.reserve(5000);
        if (isAnothers)
            scratch.write(used, pieceOf(5000, 3), 5000);
        else
            for (const std::uint64_t place : {used, unused}) scratch.clear(place, 5000);
        ASSERT_TRUE(scratch.flush().ok());
        EXPECT_EQ(std::filesystem::file_size(path), used + Scratch::stride(5000));
        EXPECT_EQ(static_cast<int>(scratch.read(used, 5000)[5]), isAnothers ? 3 : 0);
        EXPECT_EQ(static_cast<int>(scratch.read(unused, 5000)[5]), 0);
    }
    std::filesystem::remove(path);
}

TEST(Scratch, StoresNoPieceThatIsForgotten) {
    const std::string path = freshPath();
    Scratch scratch(path, 1 << 20);
    const std::uint64_t kept = scratch.reserve(5000);
    const std::uint64_t forgotten = scratch.reserve(5000);
    for (const std::uint64_t place : {kept, forgotten})
        scratch.write(place, pieceOf(5000, 3), 5000);
    scratch.forget(forgotten);
    ASSERT_TRUE(scratch.flush().ok());
    EXPECT_EQ(std::filesystem::file_size(path), kept + Scratch::stride(5000));
    EXPECT_EQ(static_cast<int>(scratch.read(forgotten, 5000)[5]), 0);
    std::filesystem::remove(path);
}

TEST(Scratch, GoesOnOnlyWithAFileThatHasAllThatWasFlushed) {
    const std::string path = freshPath();
    std::uint64_t flushed = 0;
    {
        Scratch scratch(path, 0);
        scratch.write(scratch.reserve(5000), pieceOf(5000, 3), 5000);
        const auto bytes = scratch.flush();
        ASSERT_TRUE(bytes.ok()) << bytes.status();
        flushed = *bytes;
    }
    EXPECT_EQ(flushed, Scratch::stride(5000));
    {
        Scratch scratch(path, 0);
        ASSERT_TRUE(scratch.takeUp(flushed));
        EXPECT_EQ(static_cast<int>(scratch.read(scratch.reserve(5000), 5000)[4999]), 3);
    }
    EXPECT_FALSE(Scratch(path, 0).takeUp(flushed + 1));
    std::filesystem::resize_file(path, flushed - 1);
    EXPECT_FALSE(Scratch(path, 0).takeUp(flushed));
    std::filesystem::remove(path);
    EXPECT_FALSE(Scratch(path, 0).takeUp(flushed));
}

TEST(Scratch, FailsWhereWhatWasWrittenIsNoLongerThere) {
    const std::string path = freshPath();
    Scratch scratch(path, 0);
    std::vector<std::uint64_t> places;
    for (int k = 0; k < 100; ++k) places.push_back(scratch.reserve(5000));
    for (const std::uint64_t place : places) scratch.write(place, pieceOf(5000, 3), 5000);
    ASSERT_TRUE(scratch.flush().ok());
    std::filesystem::resize_file(path, 5000);
    for (const std::uint64_t place : places) scratch.read(place, 5000);
    EXPECT_TRUE(absl::IsDataLoss(scratch.status())) << scratch.status();
    EXPECT_NE(scratch.status().ToString().find(path), std::string::npos);
    std::filesystem::remove(path);
}

/// A bit of a piece, another piece, and one of a scratch that has these pieces elsewhere.
TEST(Scratch, FailsWhereSomethingElseIsThanWhatWasWritten) {
    const std::string path = freshPath();
    const auto bytesAt = [&](std::uint64_t place, std::size_t count) {
        std::string bytes(count, 0);
        std::ifstream file(path, std::ios::binary);
        file.seekg(static_cast<std::streamoff>(place)).read(bytes.data(), std::ssize(bytes));
        return bytes;
    };
    for (const bool isMoved : {false, true}) {
        Scratch scratch(path, 0);
        const std::uint64_t first = scratch.reserve(5000, 2);
        const std::uint64_t second = first + Scratch::stride(5000);
        for (const std::uint64_t place : {first, second})
            scratch.write(place, pieceOf(5000, place == first ? 3 : 4), 5000);
        ASSERT_TRUE(scratch.flush().ok());
        std::string bytes = bytesAt(second, Scratch::stride(5000));
        if (!isMoved) {
            bytes = bytesAt(first, Scratch::stride(5000));
            bytes[4321] ^= 1;
        }
        {
            std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
            file.seekp(static_cast<std::streamoff>(first)).write(bytes.data(), std::ssize(bytes));
        }
        Scratch later(path, 0);
        ASSERT_EQ(later.reserve(5000, 2), first);
        ASSERT_TRUE(later.takeUp(second + Scratch::stride(5000)));
        EXPECT_EQ(static_cast<int>(later.read(second, 5000)[5]), 4);
        EXPECT_TRUE(later.status().ok()) << later.status();
        EXPECT_EQ(static_cast<int>(later.read(first, 5000)[5]), 0);
        EXPECT_TRUE(absl::IsDataLoss(later.status())) << later.status();
        EXPECT_NE(later.status().ToString().find(path + ": scratch file has something else"),
                  std::string::npos);
        std::filesystem::remove(path);
    }
}

/// What is flushed may leave memory at the same time, for what is written meanwhile.
TEST(Scratch, GivesBackWhatIsReadAndWrittenDuringAFlush) {
    constexpr std::size_t kPlaces = 400;
    constexpr std::size_t kBytes = 5000;
    const std::string path = freshPath();
    Scratch scratch(path, kPlaces * kBytes / 4);
    std::vector<std::uint64_t> places;
    for (std::size_t k = 0; k < 2 * kPlaces; ++k) places.push_back(scratch.reserve(kBytes));
    const auto write = [&](std::size_t k) {
        scratch.write(places[k], pieceOf(kBytes, static_cast<int>(k % 255 + 1)), kBytes);
    };
    const auto isThere = [&](std::size_t k) {
        return scratch.read(places[k], kBytes)[kBytes - 1] == static_cast<std::byte>(k % 255 + 1);
    };
    for (std::size_t k = 0; k < kPlaces; ++k) write(k);
    std::thread flushing([&] { EXPECT_TRUE(scratch.flush().ok()); });
    for (std::size_t k = 0; k < kPlaces; ++k) {
        write(kPlaces + k);
        EXPECT_TRUE(isThere(k)) << k;
    }
    flushing.join();
    for (std::size_t k = 0; k < 2 * kPlaces; ++k) EXPECT_TRUE(isThere(k)) << k;
    std::filesystem::remove(path);
}

TEST(Scratch, SaysThatTheDiskIsFullAndHowToGoOn) {
    Scratch scratch("/dev/full", 1000);
    const std::uint64_t place = scratch.reserve(100000);
    scratch.write(place, pieceOf(100000, 3), 100000);
    const absl::Status status = scratch.flush().status();
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_NE(status.ToString().find("start over with --scratch"), std::string::npos);
    EXPECT_EQ(scratch.status(), status);
}

/// Clamped at the border, over any number of tiles.
RC_GTEST_PROP(TiledRaster, ReadsAnyRectangleAcrossTiles, ()) {
    const auto columns = *rc::gen::inRange(1, 400);
    const auto rows = *rc::gen::inRange(1, 300);
    Scratch scratch("/nowhere", 1 << 30);
    TiledRaster<float> raster(scratch, columns, rows);
    const auto valueAt = [](std::int32_t i, std::int32_t j) {
        return static_cast<float>(i) + 1000.0F * static_cast<float>(j);
    };
    for (std::int32_t y = 0; y < raster.tilesY(); ++y)
        for (std::int32_t x = 0; x < raster.tilesX(); ++x) {
            auto tile = TiledRaster<float>::newTile();
            for (std::int32_t v = 0; v < kRasterTilePosts; ++v)
                for (std::int32_t u = 0; u < kRasterTilePosts; ++u)
                    tile[static_cast<std::size_t>(v * kRasterTilePosts + u)] =
                        valueAt(x * kRasterTileCells + u, y * kRasterTileCells + v);
            raster.write(x, y, std::move(tile));
        }
    const auto i = *rc::gen::inRange(0, columns);
    const auto j = *rc::gen::inRange(0, rows);
    const PostRect rect{i - *rc::gen::inRange(0, 3), j - *rc::gen::inRange(0, 3),
                        *rc::gen::inRange(3, 200), *rc::gen::inRange(3, 200)};
    std::vector<float> read(static_cast<std::size_t>(rect.columns * rect.rows));
    readClamped(raster, rect, read.data());
    for (std::int32_t v = 0; v < rect.rows; ++v)
        for (std::int32_t u = 0; u < rect.columns; ++u)
            RC_ASSERT(read[static_cast<std::size_t>(v * rect.columns + u)] ==
                      valueAt(std::clamp(rect.i + u, 0, columns - 1),
                              std::clamp(rect.j + v, 0, rows - 1)));
}

}  // namespace
}  // namespace eyrie::terrain
