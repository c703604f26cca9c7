// SPDX-License-Identifier: Apache-2.0
// Pages whose checksum is right and whose bytes are anything: decoding them must end in DataLoss or
// in a page that can be used, within its bounds (the sanitizers see to that).
#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "renderer/terrain/eyt_layout.h"
#include "tests/renderer/terrain/sample_pages.h"

namespace eyrie {
namespace {

using terrain::Page;
using terrain::PageHeader;
using test::GridKind;
using Words = std::vector<std::uint32_t>;

/// One of each sort: dense and sparse, cut off and whole, short and long words, level 0 and 3.
std::vector<Words> realPages() {
    std::vector<Words> pages;
    const auto take = [&](const test::SampleTerrain& terrain, int level) {
        for (const test::SamplePage& page : test::samplePages(terrain))
            if (page.level == level)
                return pages.push_back(page.bytes);
    };
    take({.columns = 65, .rows = 65}, 0);
    take({.kind = GridKind::Noise, .columns = 50, .rows = 70, .nodataShare = 0.1}, 0);
    take({.kind = GridKind::Noise, .columns = 70, .rows = 50, .stepMetres = 1.0 / 1024}, 1);
    take({.columns = 260, .rows = 40, .nodataShare = 0.01, .finestThresholdMetres = 4}, 3);
    return pages;
}

/// How often bytes were refused; fails the test where it was not with DataLoss, or where a page
/// that passed cannot be used.
class Trial {
public:
    void decode(const Words& bytes) {
        ++rounds;
        const auto page = Page::decode(bytes, "damaged.eyt: page 7");
        if (page.ok()) {
            EXPECT_EQ(test::broken(*page), "");
            return;
        }
        ++refused;
        const std::string message = page.status().ToString();
        EXPECT_EQ(page.status().code(), absl::StatusCode::kDataLoss) << message;
        EXPECT_NE(message.find("damaged.eyt: page 7"), std::string::npos) << message;
    }

    int rounds = 0;
    int refused = 0;
};

char* bytesOf(Words& words) { return reinterpret_cast<char*>(words.data()); }

std::int32_t lastByte(const Words& words) {
    return static_cast<std::int32_t>(4 * words.size()) - 1;
}

TEST(PageDamage, IsRefusedWhereverAPageEnds) {
    for (const Words& page : realPages()) {
        Trial trial;
        for (std::size_t size = 1; size < page.size(); size += 1 + size / 64)
            trial.decode({page.begin(), page.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_EQ(trial.refused, trial.rounds);
    }
}

/// The header made to agree with what is left of one of the three parts.
TEST(PageDamage, IsRefusedWhereverAPartEnds) {
    for (const Words& page : realPages()) {
        PageHeader header;
        std::memcpy(static_cast<void*>(&header), page.data(), sizeof header);
        std::uint32_t end = sizeof header;
        for (std::uint32_t PageHeader::*part :
             {&PageHeader::wordBytes, &PageHeader::rawBytes, &PageHeader::normalBytes}) {
            end += header.*part;
            Trial trial;
            for (std::uint32_t cut = 4; cut <= header.*part; cut += 4 + cut / 16 / 4 * 4) {
                PageHeader shorter = header;
                shorter.*part -= cut;
                Words damaged = page;
                char* bytes = bytesOf(damaged);
                std::memmove(bytes + end - cut, bytes + end, 4 * page.size() - end);
                std::memcpy(bytes, &shorter, sizeof shorter);
                damaged.resize(page.size() - cut / 4);
                trial.decode(damaged);
            }
            EXPECT_EQ(trial.refused, trial.rounds);
        }
    }
}

TEST(PageDamage, NeverLeadsOutOfBoundsWhateverBitsFlip) {
    test::Random random(1);
    for (const Words& page : realPages()) {
        Trial trial;
        for (int round = 0; round < 1200; ++round) {
            Words damaged = page;
            for (int flips = random.integer(1, 3); flips > 0; --flips) {
                const std::int32_t last = round % 2 == 0 ? lastByte(page) : 271;  // the header
                char& byte = bytesOf(damaged)[random.integer(0, last)];
                byte = static_cast<char>(byte ^ 1 << random.integer(0, 7));
            }
            trial.decode(damaged);
        }
        EXPECT_GT(trial.refused, 1000);
    }
}

TEST(PageDamage, NeverLeadsOutOfBoundsWhateverIsSplicedIn) {
    test::Random random(2);
    const std::vector<Words> pages = realPages();
    for (const Words& page : pages) {
        Trial trial;
        for (int round = 0; round < 600; ++round) {
            Words damaged = page;
            const Words& other = pages[static_cast<std::size_t>(random.integer(0, 3))];
            const std::int32_t size =
                random.integer(1, std::min(lastByte(page), lastByte(other)) / 2);
            char* to = bytesOf(damaged) + random.integer(0, lastByte(page) - size);
            if (round % 3 == 0)
                for (std::int32_t k = 0; k < size; ++k) to[k] = static_cast<char>(random.next());
            else
                std::memcpy(to,
                            reinterpret_cast<const char*>(other.data()) +
                                random.integer(0, lastByte(other) - size),
                            static_cast<std::size_t>(size));
            trial.decode(damaged);
        }
        EXPECT_GT(trial.refused, 500);
    }
}

/// Bits that all say the same: the longest walks and the longest raw bits there are.
TEST(PageDamage, NeverLeadsOutOfBoundsWhereAllBitsAreAlike) {
    for (const Words& page : realPages())
        for (const int fill : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
            Words damaged = page;
            std::memset(bytesOf(damaged) + sizeof(PageHeader), fill,
                        4 * damaged.size() - sizeof(PageHeader));
            Trial trial;
            trial.decode(damaged);
            EXPECT_EQ(trial.refused, 1);
        }
}

}  // namespace
}  // namespace eyrie
