// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/shard_plan.h"
#include "renderer/import/terrain_import.h"

namespace eyrie::import {

/// What a shard of an import made.
struct TerrainShardReport {
    std::string part;  ///< the file
    std::uint64_t posts = 0;
    std::uint64_t pages = 0;
    std::uint64_t textures = 0;
    std::uint64_t sizeBytes = 0;
    bool wasThere = false;                ///< it was made, and is whole, already
    std::vector<std::string> notes = {};  ///< what was assumed or changed, for people
};

/// Does one share of an import into `out`, most of its work: reads its part of the posts, measures
/// it and builds its pages of levels 0 to 2, see ShardPlan. It leaves them in partPath(out, shard),
/// which appears whole or not at all; a part that is there, whole and of the same sources and
/// options is kept. When all parts are there, importTerrain with mergesParts makes the file of
/// them.
///
/// Shards run on any machines that share out's folder, at once or one after the other, each any
/// number of times, even the same at the same time. Needs importTerrain's memory. Of imagery it
/// makes its share of the texture tiles of level 0.
///
/// Stages reported: checking, reading, surveying, measuring, joining, building, imagery. Errors:
/// those of importTerrain, shareFacts, PartWriter; FailedPrecondition where the same shard is at
/// work on the same scratch; InvalidArgument for a shard that is none of its count, and where `out`
/// is no file.
absl::StatusOr<TerrainShardReport> importTerrainShard(const std::vector<std::string>& dems,
                                                      const std::string& out, const Shard& shard,
                                                      const TerrainImportOptions& options,
                                                      const ImportControl& control);

/// The same of any source of posts; `source.hash` stands for all that it would give.
absl::StatusOr<TerrainShardReport> importTerrainShard(HeightSource& posts,
                                                      const TerrainSource& source,
                                                      const std::string& out, const Shard& shard,
                                                      const TerrainImportOptions& options,
                                                      const ImportControl& control);

}  // namespace eyrie::import
