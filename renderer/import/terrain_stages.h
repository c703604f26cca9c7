// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "renderer/import/import_journal.h"
#include "renderer/import/shard_part.h"
#include "renderer/terrain/scratch.h"

namespace eyrie::import {

/// Stands for all that the stages of an import, or of a shard of it, depend on.
std::uint64_t stagesKey(const PartIdentity& identity, std::uint32_t shard);

/// The stages of an import whose results lie on a scratch. Where that has a file, finished stages
/// are kept in a journal beside it and are not run again; where all fits in memory there is no
/// file, no journal and nothing to go on from.
class TerrainStages {
public:
    /// `key` is stagesKey's. What a killed job has left there is gone on from if it was for the
    /// same and is all there still, and removed if this one `startsOver`.
    /// What one has left at `beside`, where it is without a folder for scratches, is removed where
    /// that is elsewhere: nothing goes on from it.
    /// Errors: ImportJournal's.
    static absl::StatusOr<TerrainStages> open(terrain::Scratch& scratch, const std::string& beside,
                                              std::uint64_t key, bool startsOver);

    /// What a stage leaves in memory, as bytes; restore is false for bytes that do not fit.
    struct State {
        std::function<std::vector<std::byte>()> save = [] { return std::vector<std::byte>(); };
        std::function<bool(const std::vector<std::byte>&)> restore =
            [](const std::vector<std::byte>&) { return true; };
    };
    /// Runs the next stage, or takes its result from the journal. What the stage left is kept while
    /// the next one runs: a job that is killed may have to do two stages again. Once one has run
    /// none is taken from the journal any more: what it leaves may lie where a later one's lay.
    absl::Status run(const std::function<absl::Status()>& work, const State& state);
    absl::Status run(const std::function<absl::Status()>& work) { return run(work, State{}); }

    /// Whether finished stages are kept at all.
    bool areKept() const { return journal_.has_value(); }
    /// Whether the same command could go on after this outcome: not with a scratch that has lost
    /// something.
    bool goesOnLater(const absl::Status& outcome) const {
        return areKept() && !outcome.ok() && !absl::IsInvalidArgument(outcome) &&
               !absl::IsDataLoss(scratch_->status());
    }

    /// What came of the job, after its last stage. Scratch file and journal go, even if a killed
    /// job with less memory has left them, unless the same command could go on with them: then the
    /// error says so.
    absl::Status end(const absl::Status& outcome);

    /// Removes what a killed job has left of a scratch, unless another is at work with it.
    static void removeLeftovers(const std::string& scratchPath);

private:
    TerrainStages(terrain::Scratch& scratch, std::optional<ImportJournal> journal)
        : scratch_(&scratch), journal_(std::move(journal)) {}

    absl::Status kept();
    void remove();

    terrain::Scratch* scratch_;
    std::optional<ImportJournal> journal_;
    std::uint32_t next_ = 0;
    /// Of the last stage. It adds to journal_, whose `find` knows earlier runs' steps only.
    std::future<absl::Status> keeping_;
};

}  // namespace eyrie::import
