// SPDX-License-Identifier: Apache-2.0
// libFuzzer target of texture pages and of what an .eyt's index says of its imagery, whose bytes
// are untrusted once their checksums are right:
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target texture_page_fuzzer
//   build/fuzz/fuzz/texture_page_fuzzer -max_len=4096 -max_total_time=600
//
// An input's first byte picks what is read: 255 takes the rest for a page as it is and 254 for an
// index. Otherwise it picks a real page, and each three bytes after it put the third at the offset
// that the first two name: so inputs reach what lies behind the frame's own checks.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "renderer/terrain/imagery/imagery_index.h"
#include "renderer/terrain/imagery/texture_page.h"

namespace {

using namespace eyrie;

constexpr std::int32_t kBlocksX = 11;
constexpr std::int32_t kBlocksY = 7;
constexpr std::uint64_t kPagesEnd = 1 << 20;

std::vector<std::byte> realPage(std::uint32_t seed) {
    std::vector<terrain::Bc1Block> blocks;
    for (std::uint32_t k = 0; k < kBlocksX * kBlocksY; ++k)
        blocks.push_back({static_cast<std::uint16_t>(0x8410 + k * seed),
                          static_cast<std::uint16_t>(0x4208 + k), k * seed * 2654435761U});
    return terrain::TexturePage::encode(blocks, kBlocksX);
}

void readPage(const std::vector<std::byte>& bytes) {
    const auto page = terrain::TexturePage::decode(bytes, kBlocksX, kBlocksY, "fuzzed");
    if (page.ok() ? page->blocks().size() != std::size_t{kBlocksX * kBlocksY}
                  : page.status().code() != absl::StatusCode::kDataLoss)
        std::abort();
}

void readIndex(std::span<const std::byte> bytes) {
    const terrain::Quadtree quadtree(600, 300);
    const auto imagery = terrain::imageryFrom(bytes, quadtree, kPagesEnd, "fuzzed");
    if (!imagery.ok() && imagery.status().code() != absl::StatusCode::kDataLoss)
        std::abort();
    if (imagery.ok())
        for (const terrain::PageRecord& tile : imagery->tiles)
            if (tile.offset + tile.bytes > kPagesEnd)
                std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    const auto rest = std::as_bytes(std::span(data + 1, size - 1));
    if (data[0] == 254) {
        readIndex(rest);
        return 0;
    }
    if (data[0] == 255) {
        readPage({rest.begin(), rest.end()});
        return 0;
    }
    static const std::vector<std::vector<std::byte>> kPages = {realPage(0), realPage(3),
                                                               realPage(977)};
    std::vector<std::byte> page = kPages[data[0] % kPages.size()];
    for (std::size_t k = 1; k + 3 <= size; k += 3)
        page[(data[k] | std::size_t{data[k + 1]} << 8) % page.size()] = std::byte{data[k + 2]};
    readPage(page);
    return 0;
}
