// SPDX-License-Identifier: Apache-2.0
#include "wire/picture_memory.h"

#include <algorithm>
#include <bit>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"

namespace eyrie::wire {
namespace {

fabric::Image noise(const fabric::PixelViewport& area, bool hasDepth, std::uint32_t seed) {
    std::mt19937 random(seed);
    fabric::Image image = fabric::makeImage(area, {}, hasDepth);
    for (fabric::Rgba& pixel : image.colour)
        pixel = std::bit_cast<fabric::Rgba>(static_cast<std::uint32_t>(random()));
    for (float& depth : image.depth)
        depth = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    return image;
}

/// NaNs are no exception.
bool isSame(const fabric::Image& a, const fabric::Image& b) {
    return a.area == b.area &&
           std::ranges::equal(std::as_bytes(std::span(a.colour)),
                              std::as_bytes(std::span(b.colour))) &&
           std::ranges::equal(std::as_bytes(std::span(a.depth)), std::as_bytes(std::span(b.depth)));
}

std::unique_ptr<PictureMemory> memoryOf(std::uint64_t bytes) {
    return PictureMemory::create(bytes).value();
}

fabric::Image taken(const PictureMemory& memory, const fabric::PixelViewport& area, bool hasDepth) {
    return fabric::copied(memory.picture(area, hasDepth).value());
}

std::string refusal(const MemoryOffer& offer) {
    const absl::Status status = PictureMemory::open(offer).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
    return std::string(status.message());
}

/// Mappings of picture memory that this process has.
std::ptrdiff_t mappings() {
    std::ifstream maps("/proc/self/maps");
    std::ptrdiff_t count = 0;
    for (std::string line; std::getline(maps, line);)
        count += line.find("memfd:eyrie picture") != std::string::npos ? 1 : 0;
    return count;
}

/// A child process that does `work` until it is killed, which this waits for.
template <typename Work>
void killMidway(Work work) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        work([&] { static_cast<void>(!write(ready[1], "x", 1)); });
        _exit(0);
    }
    close(ready[1]);
    char begun = 0;
    EXPECT_EQ(read(ready[0], &begun, 1), 1) << "it has ended by itself";
    close(ready[0]);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(PictureMemory, APictureOfAnyBitsComesOutAsItWentIn) {
    for (const bool hasDepth : {true, false})
        for (const fabric::PixelViewport area :
             {fabric::PixelViewport{0, 0, 1, 1}, fabric::PixelViewport{3, 5, 511, 257},
              fabric::PixelViewport{0, 0, 1024, 1}, fabric::PixelViewport{}}) {
            const auto memory = memoryOf(1 << 21);
            const auto there = PictureMemory::open(memory->offer()).value();
            const fabric::Image picture = noise(area, hasDepth, 7);
            ASSERT_TRUE(there->put(picture));
            EXPECT_TRUE(isSame(taken(*memory, area, hasDepth), picture));
        }
}

TEST(PictureMemory, WhatIsWrittenIntoItsRoomComesOut) {
    const auto memory = memoryOf(64 * 64 * 8);
    const auto there = PictureMemory::open(memory->offer()).value();
    for (const bool hasDepth : {true, false}) {
        const fabric::Image picture = noise({5, 6, 64, 64}, hasDepth, 11);
        const auto room = there->room(picture.area, hasDepth);
        ASSERT_TRUE(room.has_value());
        EXPECT_EQ(room->depth != nullptr, hasDepth);
        std::ranges::copy(picture.colour, room->colour);
        std::ranges::copy(picture.depth, room->depth);
        EXPECT_TRUE(isSame(taken(*memory, picture.area, hasDepth), picture));
    }
    EXPECT_FALSE(there->room({0, 0, 65, 64}, true).has_value());
    EXPECT_TRUE(there->room({0, 0, 128, 64}, false).has_value());
    EXPECT_FALSE(there->room({0, 0, 16384, 16384}, false).has_value());
}

TEST(PictureMemory, APictureThatIsTooLargeIsNeitherPutNorTaken) {
    const auto memory = memoryOf(16 * 16 * 8);
    const auto there = PictureMemory::open(memory->offer()).value();
    EXPECT_TRUE(there->put(noise({0, 0, 16, 16}, true, 1)));
    EXPECT_FALSE(there->put(noise({0, 0, 17, 16}, true, 1)));
    EXPECT_TRUE(memory->picture({0, 0, 16, 16}, true).ok());
    EXPECT_EQ(memory->picture({0, 0, 17, 16}, true).status().code(),
              absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(memory->picture({0, 0, 16384, 16384}, true).status().code(),
              absl::StatusCode::kInvalidArgument);
}

TEST(PictureMemory, SizesThatAreLiesAreRefused) {
    const auto memory = memoryOf(8192);
    for (const std::uint64_t bytes :
         {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{8191}, std::uint64_t{8193},
          PictureMemory::kMaxBytes, PictureMemory::kMaxBytes + 1,
          std::numeric_limits<std::uint64_t>::max(),
          std::numeric_limits<std::uint64_t>::max() - 4095}) {
        MemoryOffer offer = memory->offer();
        offer.bytes = bytes;
        EXPECT_THAT(refusal(offer), testing::HasSubstr(std::to_string(bytes)));
    }
}

TEST(PictureMemory, ItsSizeCannotBeChangedBeneathTheOther) {
    const auto memory = memoryOf(8192);
    EXPECT_NE(ftruncate(memory->offer().descriptor, 0), 0);
    EXPECT_NE(ftruncate(memory->offer().descriptor, 1 << 20), 0);
}

TEST(PictureMemory, AnotherKeyIsRefused) {
    const auto memory = memoryOf(8192);
    MemoryOffer offer = memory->offer();
    offer.key[31] = static_cast<char>(offer.key[31] ^ 1);
    EXPECT_THAT(refusal(offer), testing::HasSubstr("another key"));
    offer.key.resize(16);
    EXPECT_THAT(refusal(offer), testing::HasSubstr("a key of 16 bytes"));
    EXPECT_NE(memory->offer().key, memoryOf(8192)->offer().key);
}

TEST(PictureMemory, WhatIsNoSealedMemoryFileIsRefused) {
    const auto memory = memoryOf(8192);
    MemoryOffer offer = memory->offer();
    const int unsealed = memfd_create("other", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    ASSERT_EQ(ftruncate(unsealed, 4096 + 8192), 0);
    ASSERT_EQ(pwrite(unsealed, offer.key.data(), offer.key.size(), 0), 32);
    offer.descriptor = unsealed;
    EXPECT_THAT(refusal(offer), testing::HasSubstr("its size may change"));

    const test::TemporaryFolder folder;
    const int file = open(folder.path("file").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    ASSERT_EQ(ftruncate(file, 4096 + 8192), 0);
    offer.descriptor = file;
    EXPECT_THAT(refusal(offer), testing::HasSubstr("its size may change"));

    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    offer.descriptor = ends[0];  // opening it would wait for a writer
    EXPECT_THAT(refusal(offer), testing::HasSubstr("no file"));
    for (const int descriptor : {unsealed, file, ends[0], ends[1]}) close(descriptor);
    EXPECT_THAT(refusal(offer), testing::HasSubstr("descriptor"));
    offer.process = -1;
    EXPECT_THAT(refusal(offer), testing::HasSubstr("process -1"));
}

TEST(PictureMemory, AWriterThatIsKilledLeavesMemoryThatCanBeReadAndNothingElse) {
    const std::ptrdiff_t before = mappings();
    {
        const auto memory = memoryOf(256 * 256 * 8);
        const fabric::Image one = noise({0, 0, 256, 256}, true, 1);
        const fabric::Image other = noise({0, 0, 256, 256}, true, 2);
        killMidway([&](const auto& begun) {
            const auto there = PictureMemory::open(memory->offer());
            if (!there.ok() || !(*there)->put(one))
                return;
            begun();
            while (true) static_cast<void>((*there)->put((*there)->put(one) ? other : one));
        });
        const fabric::Image torn = taken(*memory, one.area, true);
        std::size_t strange = 0;
        for (std::size_t i = 0; i < torn.colour.size(); ++i)
            strange += torn.colour[i] == one.colour[i] || torn.colour[i] == other.colour[i] ? 0 : 1;
        EXPECT_LE(strange, 1U);  // a pixel may be of both
        EXPECT_GT(mappings(), before);
    }
    EXPECT_EQ(mappings(), before);
}

TEST(PictureMemory, AnOwnerThatIsKilledTakesNothingAway) {
    int offers[2];
    ASSERT_EQ(pipe(offers), 0);
    std::unique_ptr<PictureMemory> there;
    const fabric::Image picture = noise({0, 0, 64, 64}, true, 3);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        const auto memory = PictureMemory::create(64 * 64 * 8);
        if (!memory.ok())
            _exit(1);
        const MemoryOffer offer = (*memory)->offer();
        const std::string key = offer.key;
        static_cast<void>(!write(offers[1], &offer.descriptor, sizeof offer.descriptor));
        static_cast<void>(!write(offers[1], key.data(), key.size()));
        pause();
        _exit(0);
    }
    close(offers[1]);
    MemoryOffer offer{child, -1, 64 * 64 * 8, std::string(32, '\0')};
    ASSERT_EQ(read(offers[0], &offer.descriptor, sizeof offer.descriptor),
              static_cast<ssize_t>(sizeof offer.descriptor));
    ASSERT_EQ(read(offers[0], offer.key.data(), 32), 32);
    close(offers[0]);
    auto opened = PictureMemory::open(offer);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(opened.ok()) << opened.status();
    there = *std::move(opened);
    ASSERT_TRUE(there->put(picture));
    EXPECT_TRUE(isSame(taken(*there, picture.area, true), picture));
    EXPECT_THAT(refusal(offer), testing::HasSubstr("process"));
}

}  // namespace
}  // namespace eyrie::wire
