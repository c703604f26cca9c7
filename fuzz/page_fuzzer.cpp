// SPDX-License-Identifier: Apache-2.0
// libFuzzer target of terrain pages, whose bytes are untrusted once their checksum is right:
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target page_fuzzer
//   build/fuzz/fuzz/page_fuzzer -max_len=4096 -max_total_time=600
//
// An input's first byte picks a real page, and each four bytes after it put the fourth at the
// offset that the first three name: so inputs reach the decoder past its checks of the header, of
// lengths and of symbol shares. 255 takes the rest of the input for a page as it is.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "renderer/terrain/eyt_format.h"
#include "tests/renderer/terrain/sample_pages.h"

namespace {

using namespace eyrie;
using Words = std::vector<std::uint32_t>;

std::vector<Words> realPages() {
    std::vector<Words> pages;
    for (const test::SampleTerrain& terrain :
         {test::SampleTerrain{.columns = 140, .rows = 70},
          test::SampleTerrain{.kind = test::GridKind::Noise, .stepMetres = 1.0 / 1024},
          test::SampleTerrain{.columns = 260, .rows = 50, .nodataShare = 0.05},
          test::SampleTerrain{
              .columns = 140, .rows = 130, .nodataShare = 0.9, .shareWithNormals = 0.5}})
        for (test::SamplePage& page : test::samplePages(terrain))
            pages.push_back(std::move(page.bytes));
    return pages;
}

Words pageOf(const std::uint8_t* data, std::size_t size) {
    static const std::vector<Words> kPages = realPages();
    if (data[0] == 255) {
        Words page((size - 1) / sizeof(std::uint32_t));
        std::memcpy(page.data(), data + 1, page.size() * sizeof(std::uint32_t));
        return page;
    }
    Words page = kPages[data[0] % kPages.size()];
    auto* bytes = reinterpret_cast<std::uint8_t*>(page.data());
    for (std::size_t k = 1; k + 4 <= size; k += 4) {
        const std::size_t offset =
            data[k] | std::size_t{data[k + 1]} << 8 | std::size_t{data[k + 2]} << 16;
        bytes[offset % (page.size() * sizeof(std::uint32_t))] = data[k + 3];
    }
    return page;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    const Words bytes = pageOf(data, size);
    const auto page = terrain::Page::decode(bytes, "fuzzed");
    if (page.ok() ? !test::broken(*page).empty()
                  : page.status().code() != absl::StatusCode::kDataLoss)
        std::abort();
    const auto outlines = terrain::Page::decode(bytes, "fuzzed", terrain::PageForm::Outlines);
    if (outlines.status() != page.status())
        std::abort();
    return 0;
}
