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

constexpr int kRounds = 3;    ///< after one that compiles and warms up
constexpr double kClear = 4;  ///< times slower: no further round is needed

/// The least of up to kRounds of each, taken in turn.
absl::StatusOr<std::pair<DecodeCost, DecodeCost>> compare(std::span<const std::uint32_t> bytes,
                                                          const TileDecoder& decoder) {
    std::pair<DecodeCost, DecodeCost> least;
    for (int round = -1; round < kRounds; ++round) {
        ASSIGN_OR_RETURN(const DecodeCost cpu, measureDecode(bytes, nullptr));
        ASSIGN_OR_RETURN(const DecodeCost gpu, measureDecode(bytes, &decoder));
        if (round <= 0 || cpu.time < least.first.time)
            least.first = cpu;
        if (round <= 0 || gpu.time < least.second.time)
            least.second = gpu;
        const auto [less, more] = std::minmax(least.first.time, least.second.time);
        if (round >= 0 && more > kClear * less)
            break;
    }
    return least;
}

void warn(const absl::Status& status) {
    spdlog::warn("decoding tiles on the CPU: {}",
                 std::string_view(status.message().data(), status.message().size()));
}

}  // namespace

absl::StatusOr<DecodeCost> measureDecode(std::span<const std::uint32_t> bytes,
                                         const TileDecoder* decoder) {
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
    glFinish();
    cost.time = Clock::now() - start;
    return cost;
}

absl::StatusOr<const TileDecoder*> DecodeChoice::decoderFor(const terrain::EytFile& file) {
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

/// On the page of the level below the top: at most four tiles, which every flight needs soon.
void DecodeChoice::measure(const terrain::EytFile& file) {
    const terrain::Quadtree& quadtree = file.index().quadtree;
    const terrain::TileId tile{std::max(0, quadtree.top().level - 1), 0, 0};
    const auto bytes = file.readPageBytes(quadtree.pageIndex(tile));
    if (!bytes.ok() || bytes->empty())
        return;  // paging reports it; another file may decide
    isChosen_ = true;
    absl::StatusOr<TileDecoder> decoder = TileDecoder::create();
    if (!decoder.ok())
        return warn(decoder.status());
    const auto costs = compare(*bytes, *decoder);
    if (!costs.ok())
        return warn(costs.status());
    const auto& [cpu, gpu] = *costs;
    if (gpu.time < cpu.time)
        decoder_ = *std::move(decoder);
    spdlog::info("decoding tiles on the {}: {:.1f} M triangles/s on the CPU, {:.1f} on the GPU",
                 decoder_ ? "GPU" : "CPU", cpu.millionTrianglesPerSecond(),
                 gpu.millionTrianglesPerSecond());
}

}  // namespace eyrie::draw
