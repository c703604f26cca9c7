// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "renderer/import/height_source.h"
#include "renderer/import/progress.h"
#include "renderer/import/shard_part.h"
#include "renderer/import/shard_plan.h"

namespace eyrie::import {

/// What all posts of the sources are like, for a shard that knows only its `own`: every height is
/// stored in steps that depend on the range of all.
///
/// Each shard leaves what it knows in a file, see factsPath, and takes the others' from theirs. It
/// never waits: what nobody has left yet it reads from `source` itself, and leaves it for the rest,
/// until a file of it appears. So shards may run one after the other, in any order, or all at once.
/// A file that is damaged or of another import counts as none.
///
/// Stage "surveying". Errors: the source's, WholeFile's, Cancelled.
absl::StatusOr<terrain::HeightStatistics> shareFacts(
    const std::string& out, const PartIdentity& identity, const ShardPlan& plan, const Shard& shard,
    const terrain::HeightStatistics& own, HeightSource& source, const ImportControl& control);

}  // namespace eyrie::import
