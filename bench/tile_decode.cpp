// SPDX-License-Identifier: Apache-2.0
// Pages decoded on the CPU beside the same pages decoded by CPU and GPU together, from their bytes
// to tiles that can be drawn.
//
//   build/release/bench/tile_decode FILE.eyt [ROUNDS=5] [PAGES=64]
//
// Prints for each way the least time of the rounds, which take turns, as millions of triangles a
// second: until the tiles are on the device, and of it, in processor time, the reading of the bits,
// which the loader's threads do; and bytes sent to the device for a tile's geometry.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/draw/decode_choice.h"
#include "renderer/gl/egl_context.h"

namespace {

using namespace eyrie;
using Seconds = std::chrono::duration<double>;

using PageBytes = std::vector<std::uint32_t>;

/// The largest pages that normals, which both ways decode alike, take no part in.
absl::StatusOr<std::vector<PageBytes>> loadPages(const terrain::EytFile& file, std::size_t count) {
    const terrain::EytIndex& index = file.index();
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t page = 0; page < index.pages.size(); ++page)
        if (index.quadtree.firstTileOfPage(page).level < index.quadtree.normalLevel() &&
            index.pages[page].bytes != 0)
            numbers.push_back(page);
    std::sort(numbers.begin(), numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
        return index.pages[a].bytes > index.pages[b].bytes;
    });
    numbers.resize(std::min(count, numbers.size()));
    std::vector<PageBytes> pages;
    for (const std::uint32_t page : numbers) {
        ASSIGN_OR_RETURN(PageBytes bytes, file.readPageBytes(page));
        pages.push_back(std::move(bytes));
    }
    if (pages.empty())
        return absl::FailedPreconditionError("the file has no pages without normals");
    return pages;
}

/// One way, over all pages.
struct Way {
    const char* name;
    draw::TileDecoder* decoder;
    draw::DecodeCost least;
    Seconds leastReading{0};

    terrain::PageForm form() const {
        return decoder == nullptr ? terrain::PageForm::Drawable : terrain::PageForm::Outlines;
    }
};

Seconds processorTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// Processor time.
absl::StatusOr<Seconds> readAll(const std::vector<PageBytes>& pages, terrain::PageForm form) {
    const Seconds start = processorTime();
    for (const PageBytes& bytes : pages)
        RETURN_IF_ERROR(terrain::Page::decode(bytes, "page", form).status());
    return processorTime() - start;
}

absl::Status measure(Way& way, const std::vector<PageBytes>& pages) {
    draw::DecodeCost sum;
    for (const PageBytes& bytes : pages) {
        ASSIGN_OR_RETURN(const draw::DecodeCost cost, draw::measureDecode(bytes, way.decoder));
        sum.time += cost.time;
        sum.triangles += cost.triangles;
        sum.tiles += cost.tiles;
        sum.bytesSent += cost.bytesSent;
    }
    ASSIGN_OR_RETURN(const Seconds reading, readAll(pages, way.form()));
    if (way.least.triangles == 0 || sum.time < way.least.time)
        way.least = sum;
    if (way.leastReading.count() == 0 || reading < way.leastReading)
        way.leastReading = reading;
    return absl::OkStatus();
}

void print(const Way& way) {
    const auto triangles = static_cast<double>(way.least.triangles);
    fmt::print(
        "{:<12} {:>7.1f} M triangles/s on the device  {:>7.1f} M/s reading the bits  {:>8.0f} "
        "bytes sent a tile\n",
        way.name, way.least.millionTrianglesPerSecond(), triangles / way.leastReading.count() / 1e6,
        static_cast<double>(way.least.bytesSent) / static_cast<double>(way.least.tiles));
}

absl::Status run(const std::string& path, int rounds, std::size_t count) {
    ASSIGN_OR_RETURN(const auto context, gl::EglContext::create(-1));
    ASSIGN_OR_RETURN(const auto file, terrain::EytFile::open(path));
    ASSIGN_OR_RETURN(const std::vector<PageBytes> pages, loadPages(*file, count));
    ASSIGN_OR_RETURN(draw::TileDecoder decoder, draw::TileDecoder::create());
    RETURN_IF_ERROR(draw::measureDecode(pages.front(), &decoder).status());  // compiles
    std::vector<Way> ways = {{"CPU", nullptr, {}, {}}, {"CPU and GPU", &decoder, {}, {}}};
    for (int round = 0; round < rounds; ++round)
        for (Way& way : ways) RETURN_IF_ERROR(measure(way, pages));
    fmt::print("{} pages of {} tiles and {} triangles on {}\n", pages.size(), ways[0].least.tiles,
               ways[0].least.triangles, context->device().renderer);
    for (const Way& way : ways) print(way);
    return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || std::string(argv[1]) == "--help") {
        fmt::print(stderr, "usage: tile_decode FILE.eyt [ROUNDS=5] [PAGES=64]\n");
        return 2;
    }
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
    const auto pages = static_cast<std::size_t>(argc > 3 ? std::max(1, std::atoi(argv[3])) : 64);
    if (const absl::Status status = run(argv[1], rounds, pages); !status.ok()) {
        fmt::print(stderr, "{}\n", status.ToString());
        return 1;
    }
    return 0;
}
