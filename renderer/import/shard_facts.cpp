// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/shard_facts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <optional>
#include <vector>

#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/import/elevation_reading.h"
#include "renderer/import/whole_file.h"

namespace eyrie::import {
namespace {

using terrain::HeightStatistics;
using terrain::kRasterTileCells;

struct FactsFile {
    std::array<char, 8> magic = {'E', 'Y', 'R', 'I', 'E', 'F', 'C', 'T'};
    PartIdentity identity;
    std::uint64_t shard = 0;
    float min = 0;
    float max = 0;
    std::uint64_t nodataPosts = 0;
    std::uint64_t allIntegers = 0;
    std::uint64_t checksum = 0;
};
static_assert(sizeof(FactsFile) == 152, "no padding");

std::uint64_t checksumOf(const FactsFile& file) {
    return XXH64(&file, offsetof(FactsFile, checksum), 0);
}

class Survey {
public:
    Survey(const std::string& out, const PartIdentity& identity, const ShardPlan& plan,
           std::uint32_t shards, HeightSource& source, const ImportControl& control)
        : out_(out),
          identity_(identity),
          plan_(plan),
          shards_(shards),
          source_(source),
          control_(control) {}

    absl::Status leave(std::uint32_t index, const HeightStatistics& facts) const {
        FactsFile content;
        content.identity = identity_;
        content.shard = index;
        content.min = facts.min;
        content.max = facts.max;
        content.nodataPosts = facts.nodataPosts;
        content.allIntegers = facts.allIntegers ? 1 : 0;
        content.checksum = checksumOf(content);
        ASSIGN_OR_RETURN(WholeFile file, WholeFile::create(factsPath(out_, {index, shards_})));
        RETURN_IF_ERROR(file.append(std::as_bytes(std::span(&content, 1))));
        return file.commit();
    }

    std::optional<HeightStatistics> left(std::uint32_t index) const {
        std::ifstream file(factsPath(out_, {index, shards_}), std::ios::binary);
        FactsFile content;
        const FactsFile expected;
        if (!file.read(reinterpret_cast<char*>(&content), sizeof content) ||
            content.magic != expected.magic || content.checksum != checksumOf(content) ||
            content.identity != identity_ || content.shard != index)
            return std::nullopt;
        return HeightStatistics{content.min, content.max, content.nodataPosts,
                                content.allIntegers != 0};
    }

    /// What another shard has left, or a look at its posts.
    absl::StatusOr<HeightStatistics> of(std::uint32_t index) {
        if (const auto facts = left(index))
            return *facts;
        HeightStatistics facts;
        std::vector<std::uint32_t> tiles = plan_.tilesOf(index);
        std::ranges::stable_sort(tiles, {}, [this](std::uint32_t tile) { return turnOf(tile); });
        for (std::size_t first = 0; first < tiles.size();) {
            const std::size_t end = runFrom(tiles, first);
            RETURN_IF_ERROR(control_.check());
            if (const auto found = left(index))
                return *found;
            RETURN_IF_ERROR(add(tiles[first], static_cast<std::int32_t>(end - first), facts));
            first = end;
        }
        RETURN_IF_ERROR(leave(index, facts));
        return facts;
    }

private:
    std::uint32_t rowOf(std::uint32_t tile) const {
        return tile / static_cast<std::uint32_t>(plan_.tilesX());
    }
    /// Quickest read in the order of these: first those of the same columns, down or up.
    std::pair<std::int64_t, std::int64_t> turnOf(std::uint32_t tile) const {
        const std::int64_t row = rowOf(tile);
        const std::int64_t column = tile - row * plan_.tilesX();
        return {column * kRasterTileCells / source_.columnsAtOnce(),
                source_.isLastRowFirst() ? -row : row};
    }

    /// Where a run of tiles side by side that are read at once ends.
    std::size_t runFrom(const std::vector<std::uint32_t>& tiles, std::size_t first) const {
        constexpr std::size_t kMostTiles = 32;
        std::size_t end = first + 1;
        while (end < tiles.size() && end - first < kMostTiles && tiles[end] == tiles[end - 1] + 1 &&
               rowOf(tiles[end]) == rowOf(tiles[first]))
            ++end;
        return end;
    }

    absl::Status add(std::uint32_t firstTile, std::int32_t tiles, HeightStatistics& facts) {
        const terrain::GridFrame& frame = source_.frame();
        const auto y = static_cast<std::int32_t>(rowOf(firstTile));
        const std::int32_t x = static_cast<std::int32_t>(firstTile) - y * plan_.tilesX();
        const std::int32_t i = x * kRasterTileCells;
        const std::int32_t j = y * kRasterTileCells;
        const terrain::PostRect window{i, j,
                                       std::min(tiles * kRasterTileCells + 1, frame.columns - i),
                                       std::min(terrain::kRasterTilePosts, frame.rows - j)};
        posts_.resize(static_cast<std::size_t>(window.columns) *
                      static_cast<std::size_t>(window.rows));
        RETURN_IF_ERROR(source_.read(window, posts_.data()));
        for (std::int32_t k = 0; k < tiles; ++k)
            countTile(frame, x + k, y, posts_.data() + k * kRasterTileCells, window.columns, facts);
        return absl::OkStatus();
    }

    const std::string& out_;
    const PartIdentity& identity_;
    const ShardPlan& plan_;
    std::uint32_t shards_;
    HeightSource& source_;
    const ImportControl& control_;
    std::vector<float> posts_;
};

}  // namespace

absl::StatusOr<HeightStatistics> shareFacts(const std::string& out, const PartIdentity& identity,
                                            const ShardPlan& plan, const Shard& shard,
                                            const HeightStatistics& own, HeightSource& source,
                                            const ImportControl& control) {
    Survey survey(out, identity, plan, shard.count, source, control);
    control.report("surveying", 0);
    RETURN_IF_ERROR(survey.leave(shard.index, own));
    HeightStatistics all = own;
    for (std::uint32_t k = 1; k < shard.count; ++k) {
        ASSIGN_OR_RETURN(const HeightStatistics facts, survey.of((shard.index + k) % shard.count));
        all.add(facts);
        control.report("surveying", static_cast<double>(k) / shard.count);
    }
    control.report("surveying", 1);
    return all;
}

}  // namespace eyrie::import
