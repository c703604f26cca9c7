// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/shard_part.h"
#include "renderer/import/shard_plan.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/vertex_levels.h"

namespace eyrie::import {

/// The parts of all shards of an import, as one. Any thread may read.
class PartSet {
public:
    /// Opens what partsFolder(out) holds; `identity` is that of this import with any number of
    /// shards, `textures` its number of texture tiles of level 0. Errors: PartFile's, and NotFound
    /// where there are no parts, or where some are missing (all of them are named); InvalidArgument
    /// where there are parts of two different splits.
    static absl::StatusOr<PartSet> open(const std::string& out, PartIdentity identity,
                                        std::uint32_t textures);

    /// What readElevation does: all heights, their statistics and summary. Stage "gathering".
    absl::Status gatherHeights(const terrain::Scratch& scratch, const ImportControl& control,
                               terrain::ElevationModel& model) const;
    /// What VertexLevels::measure does. Stage "collecting".
    absl::Status gatherMeasured(const terrain::Scratch& scratch, const ImportControl& control,
                                terrain::VertexLevels& levels) const;

    bool hasPage(std::uint32_t page) const { return plan_.hasOwner(page); }
    absl::StatusOr<std::vector<std::uint32_t>> readPage(std::uint32_t page, PageTiles& tiles) const;

    /// Errors: PartFile's.
    absl::StatusOr<TexturePiece> readTexture(std::uint32_t texture, std::size_t halfTexels) const;

    /// Removes the parts and what belongs to them: the import is done. Returns what there is to be
    /// said of what stays in their folder, as of shards of another split.
    std::vector<std::string> remove();

private:
    PartSet(std::string out, ShardPlan plan) : out_(std::move(out)), plan_(std::move(plan)) {}

    std::string out_;
    ShardPlan plan_;
    std::vector<PartFile> parts_;  ///< by shard
};

}  // namespace eyrie::import
