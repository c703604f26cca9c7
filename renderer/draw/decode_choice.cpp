// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/decode_choice.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "fabric/log.h"
#include "fabric/status.h"
#include "renderer/draw/terrain_tiles.h"

namespace eyrie::draw {
namespace {

using Clock = std::chrono::steady_clock;
using PageBytes = std::vector<std::uint32_t>;

constexpr int kRounds = 3;    ///< after one that compiles and warms up
constexpr double kClear = 4;  ///< times slower: nothing further is measured

struct Costs {
    DecodeCost cpu;
    DecodeCost gpu;
};

bool isClear(const Costs& costs) {
    const auto [less, more] = std::minmax(costs.cpu.time, costs.gpu.time);
    return more > kClear * less;
}

/// The least of up to kRounds of each, taken in turn.
absl::StatusOr<Costs> compare(std::span<const std::uint32_t> bytes, TileDecoder& decoder) {
    Costs least;
    for (int round = -1; round < kRounds; ++round) {
        ASSIGN_OR_RETURN(const DecodeCost cpu, measureDecode(bytes, nullptr));
        ASSIGN_OR_RETURN(const DecodeCost gpu, measureDecode(bytes, &decoder));
        if (round <= 0 || cpu.time < least.cpu.time)
            least.cpu = cpu;
        if (round <= 0 || gpu.time < least.gpu.time)
            least.gpu = gpu;
        if (round >= 0 && isClear(least))
            break;
    }
    return least;
}

/// Pages that every flight needs soon: of the level below the top, up to four tiles, and of the
/// next, sixteen, which a GPU makes side by side.
std::vector<PageBytes> soonNeeded(const terrain::EytFile& file) {
    const terrain::Quadtree& quadtree = file.index().quadtree;
    std::vector<PageBytes> pages;
    for (int level = std::max(0, quadtree.top().level - 1);
         level >= std::max(0, quadtree.top().level - 2); --level) {
        auto bytes = file.readPageBytes(quadtree.pageIndex(terrain::TileId{level, 0, 0}));
        if (!bytes.ok() || bytes->empty())
            break;
        pages.push_back(*std::move(bytes));
    }
    return pages;
}

void warn(const absl::Status& status) {
    spdlog::warn("decoding tiles on the CPU: {}",
                 std::string_view(status.message().data(), status.message().size()));
}

}  // namespace

absl::StatusOr<DecodeCost> measureDecode(std::span<const std::uint32_t> bytes,
                                         TileDecoder* decoder) {
    glFinish();
    DecodeCost cost;
    const auto start = Clock::now();
    ASSIGN_OR_RETURN(const terrain::Page page,
                     terrain::Page::decode(bytes, "page",
                                           decoder == nullptr ? terrain::PageForm::Drawable
                                                              : terrain::PageForm::Outlines));
    std::vector<DeviceTile> tiles;
    tiles.reserve(terrain::kPageTiles * terrain::kPageTiles);
    for (int place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place) {
        terrain::TileGeometry geometry = page.tile(place);
        geometry.normals = {};
        if (geometry.isEmpty())
            continue;
        tiles.emplace_back(geometry, decoder);
        ++cost.tiles;
        cost.triangles += geometry.indexCount() / 3;
        cost.bytesSent += decoder == nullptr ? geometry.wordBytes() + geometry.indexBytes()
                                             : geometry.outline.size_bytes();
    }
    if (decoder != nullptr)
        decoder->publish();
    glFinish();
    cost.time = Clock::now() - start;
    return cost;
}

absl::StatusOr<TileDecoder*> DecodeChoice::decoderFor(const terrain::EytFile& file) {
    if (isChosen_ || asked_ == TileDecoding::Cpu)
        return chosen();
    if (asked_ == TileDecoding::Auto) {
        measure(file);
        return chosen();
    }
    ASSIGN_OR_RETURN(TileDecoder decoder, TileDecoder::create());
    decoder_ = std::move(decoder);
    isChosen_ = true;
    return chosen();
}

void DecodeChoice::measure(const terrain::EytFile& file) {
    const std::vector<PageBytes> pages = soonNeeded(file);
    if (pages.empty())
        return;  // paging reports it; another file may decide
    isChosen_ = true;
    absl::StatusOr<TileDecoder> decoder = TileDecoder::create();
    if (!decoder.ok())
        return warn(decoder.status());
    absl::StatusOr<Costs> costs = compare(pages.front(), *decoder);
    if (costs.ok() && pages.size() > 1 && !isClear(*costs))
        costs = compare(pages[1], *decoder);
    if (!costs.ok())
        return warn(costs.status());
    if (costs->gpu.time < costs->cpu.time)
        decoder_ = *std::move(decoder);
    spdlog::info("decoding tiles on the {}: {:.1f} M triangles/s on the CPU, {:.1f} on the GPU",
                 decoder_ ? "GPU" : "CPU", costs->cpu.millionTrianglesPerSecond(),
                 costs->gpu.millionTrianglesPerSecond());
}

}  // namespace eyrie::draw
