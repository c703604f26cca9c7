// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_layout.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/support/memory_limit.h"

namespace eyrie {
namespace {

using test::GridKind;

std::vector<char> bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void writeBytes(const std::string& path, const std::vector<char>& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Uses all that a page offers, as a renderer would.
std::uint64_t touched(const terrain::Page& page) {
    std::uint64_t sum = 0;
    for (int place = 0; place < 16; ++place) {
        const terrain::TileGeometry& tile = page.tile(place);
        for (const terrain::IndexRange& part : tile.parts)
            for (std::uint32_t k = part.first; k < part.first + part.count; ++k)
                sum += tile.words[tile.indices[k] * static_cast<std::size_t>(tile.wordsPerVertex)];
        for (const std::int8_t normal : tile.normals) sum += static_cast<std::uint8_t>(normal);
    }
    return sum;
}

/// Whether the file opens and all its pages can be read; anything else must be a status.
bool isReadable(const std::string& path) {
    const auto file = terrain::EytFile::open(path);
    if (!file.ok())
        return false;
    for (std::uint32_t page = 0; page < (*file)->index().pages.size(); ++page) {
        const auto read = (*file)->readPage(page);
        if (!read.ok())
            return false;
        touched(**read);
    }
    return true;
}

class EytDamage : public testing::Test {
protected:
    void SetUp() override {
        const auto file = test::imported(test::hardGrid(GridKind::Smooth, 140, 70, 1), folder_);
        ASSERT_NE(file, nullptr);
        path_ = file->path();
        bytes_ = bytesOf(path_);
        ASSERT_TRUE(isReadable(path_));
    }

    test::TemporaryFolder folder_;
    std::string path_;
    std::vector<char> bytes_;
};

TEST_F(EytDamage, IsNoticedWhateverBitFlips) {
    test::Random random(1);
    for (int round = 0; round < 300; ++round) {
        std::vector<char> damaged = bytes_;
        // Every second flip in header or index, the small parts where most depends on each bit.
        const auto size = static_cast<std::int32_t>(bytes_.size());
        const std::int32_t place = round % 2 == 0   ? random.integer(0, size - 1)
                                   : round % 4 == 1 ? random.integer(0, 207)
                                                    : random.integer(size - 600, size - 1);
        char& byte = damaged[static_cast<std::size_t>(place)];
        byte = static_cast<char>(byte ^ 1 << random.integer(0, 7));
        writeBytes(path_, damaged);
        EXPECT_FALSE(isReadable(path_)) << "byte " << place;
    }
}

TEST_F(EytDamage, IsNoticedWhereverTheFileEnds) {
    test::Random random(2);
    for (int round = 0; round < 100; ++round) {
        std::vector<char> damaged = bytes_;
        damaged.resize(round < 10 ? static_cast<std::size_t>(round * 25)
                                  : static_cast<std::size_t>(random.integer(
                                        0, static_cast<std::int32_t>(bytes_.size()) - 1)));
        writeBytes(path_, damaged);
        EXPECT_FALSE(isReadable(path_)) << damaged.size() << " bytes";
    }
}

/// A few blocks on disk may claim a file of terabytes.
TEST_F(EytDamage, AnIndexLargerThanItsPostsCanHaveIsRefusedBeforeItIsRead) {
    terrain::FileHeader header;
    std::memcpy(static_cast<void*>(&header), bytes_.data(), sizeof header);
    header.indexBytes = std::uint64_t{1} << 43;
    header.headerChecksum = XXH64(&header, offsetof(terrain::FileHeader, headerChecksum), 0);
    std::memcpy(bytes_.data(), &header, sizeof header);
    writeBytes(path_, bytes_);
    std::filesystem::resize_file(path_, header.indexOffset + header.indexBytes);
    const absl::Status refused = terrain::EytFile::open(path_).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kDataLoss);
    EXPECT_NE(refused.ToString().find(path_ + ": header.indexBytes is 8796093022208"),
              std::string::npos)
        << refused;
}

TEST_F(EytDamage, AnIndexIsInMemoryOnce) {
    if (!test::MemoryLimit::kIsPossible)
        GTEST_SKIP() << "sanitizers take more memory than a limit would leave";
    terrain::FileHeader header;
    std::memcpy(static_cast<void*>(&header), bytes_.data(), sizeof header);
    header.columns = header.rows = 45'000;
    const terrain::Quadtree quadtree(45'000, 45'000);
    header.levels = static_cast<std::uint32_t>(quadtree.levels());
    header.crsBytes = 0;
    header.indexOffset = sizeof header;
    header.indexBytes = terrain::roundUp(quadtree.tileCount() * sizeof(terrain::TileRecord), 8) +
                        quadtree.pageCount() * sizeof(terrain::PageRecord);
    header.indexChecksum = XXH64(std::vector<char>(header.indexBytes).data(), header.indexBytes, 0);
    header.headerChecksum = XXH64(&header, offsetof(terrain::FileHeader, headerChecksum), 0);
    writeBytes(path_, {reinterpret_cast<const char*>(&header),
                       reinterpret_cast<const char*>(&header) + sizeof header});
    std::filesystem::resize_file(path_, header.indexOffset + header.indexBytes);
    {
        const test::MemoryLimit limit(header.indexBytes * 3 / 2);
        const auto file = terrain::EytFile::open(path_);
        ASSERT_TRUE(file.ok()) << file.status();
        EXPECT_LT((*file)->indexMemoryBytes(), header.indexBytes * 5 / 4);
    }
    const test::MemoryLimit limit(header.indexBytes / 2);
    const absl::Status refused = terrain::EytFile::open(path_).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted) << refused;
    EXPECT_NE(refused.ToString().find("its index takes"), std::string::npos) << refused;
}

TEST_F(EytDamage, APageLargerThanItsTilesCanHaveIsRefusedBeforeItIsRead) {
    terrain::FileHeader header;
    std::memcpy(static_cast<void*>(&header), bytes_.data(), sizeof header);
    constexpr std::uint64_t kLong = std::uint64_t{300} << 30;
    std::vector<char> index(bytes_.begin() + static_cast<std::ptrdiff_t>(header.indexOffset),
                            bytes_.end());
    const terrain::PageRecord page{.offset = sizeof header, .bytes = kLong, .checksum = 1};
    std::memcpy(index.data() + index.size() - sizeof page, &page, sizeof page);
    header.indexOffset = kLong + sizeof header;
    header.indexChecksum = XXH64(index.data(), index.size(), 0);
    header.headerChecksum = XXH64(&header, offsetof(terrain::FileHeader, headerChecksum), 0);
    writeBytes(path_, {reinterpret_cast<const char*>(&header),
                       reinterpret_cast<const char*>(&header) + sizeof header});
    std::filesystem::resize_file(path_, header.indexOffset);
    std::ofstream(path_, std::ios::binary | std::ios::app)
        .write(index.data(), static_cast<std::streamsize>(index.size()));
    const absl::Status refused = terrain::EytFile::open(path_).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kDataLoss);
    EXPECT_NE(refused.ToString().find("322122547200 bytes at 208 are too many"), std::string::npos)
        << refused;
}

TEST_F(EytDamage, OfTheMagicOrVersionIsCalledWhatItIs) {
    std::vector<char> damaged = bytes_;
    damaged[0] = 'X';
    writeBytes(path_, damaged);
    EXPECT_EQ(terrain::EytFile::open(path_).status().code(), absl::StatusCode::kInvalidArgument);
    damaged = bytes_;
    damaged[8] = 9;
    writeBytes(path_, damaged);
    const absl::Status newer = terrain::EytFile::open(path_).status();
    EXPECT_EQ(newer.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(newer.ToString().find("version is 9"), std::string::npos) << newer;
    damaged[8] = 1;
    writeBytes(path_, damaged);
    const absl::Status older = terrain::EytFile::open(path_).status();
    EXPECT_EQ(older.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(older.ToString().find("import the elevation model again"), std::string::npos)
        << older;
    EXPECT_EQ(terrain::EytFile::open(folder_.path("none.eyt")).status().code(),
              absl::StatusCode::kNotFound);
    EXPECT_EQ(terrain::EytFile::open(folder_.path("")).status().code(),
              absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyrie
