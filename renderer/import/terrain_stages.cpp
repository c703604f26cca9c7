// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_stages.h"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/name_beside.h"
#include "fabric/status.h"

namespace eyrie::import {
namespace {

std::string journalPath(const std::string& scratchPath) {
    return fabric::nameBeside(scratchPath, ".journal");
}

}  // namespace

std::uint64_t stagesKey(const PartIdentity& identity, std::uint32_t shard) {
    constexpr std::uint64_t kVersion = 10;  // raise it when scratch or journal change
    return XXH64(&identity, sizeof identity, kVersion << 32 | shard);
}

absl::StatusOr<TerrainStages> TerrainStages::open(terrain::Scratch& scratch,
                                                  const std::string& beside, std::uint64_t key,
                                                  bool startsOver) {
    if (beside != scratch.path())
        removeLeftovers(beside);
    if (scratch.fitsInMemory()) {
        if (startsOver)
            removeLeftovers(scratch.path());
        return TerrainStages(scratch, std::nullopt);
    }
    ASSIGN_OR_RETURN(ImportJournal journal,
                     ImportJournal::open(journalPath(scratch.path()), key, startsOver));
    if (!journal.isEmpty() && !scratch.takeUp(journal.resultBytes()))
        RETURN_IF_ERROR(journal.clear());
    if (journal.isEmpty())
        unlink(scratch.path().c_str());
    return TerrainStages(scratch, std::move(journal));
}

absl::Status TerrainStages::run(const std::function<absl::Status()>& work, const State& state) {
    const std::uint32_t step = next_++;
    if (!journal_)
        return work();
    const std::vector<std::byte>* done = journal_->find(step);
    if (done != nullptr && state.restore(*done)) {
        journal_->release(step);
        return absl::OkStatus();
    }
    RETURN_IF_ERROR(journal_->dropFrom(step));
    RETURN_IF_ERROR(work());
    RETURN_IF_ERROR(kept());
    keeping_ = std::async(std::launch::async, [this, step, bytes = state.save()] {
        const absl::StatusOr<std::uint64_t> flushed = scratch_->flush();
        return flushed.ok() ? journal_->add(step, bytes, *flushed) : flushed.status();
    });
    return absl::OkStatus();
}

/// What became of keeping the last stage; waits for it.
absl::Status TerrainStages::kept() { return keeping_.valid() ? keeping_.get() : absl::OkStatus(); }

absl::Status TerrainStages::end(const absl::Status& outcome) {
    if (!goesOnLater(outcome)) {
        // Called off, one that fits in memory leaves what a later one may go on from.
        if (areKept() || outcome.ok())
            remove();
        return outcome;
    }
    // Where it cannot be kept it is done again.
    static_cast<void>(kept());
    const auto message = outcome.message();
    return absl::Status(
        outcome.code(),
        fmt::format("{}; what is done is kept in {}: the same command goes on from there",
                    std::string_view(message.data(), message.size()), scratch_->path()));
}

void TerrainStages::remove() {
    if (!journal_)
        return removeLeftovers(scratch_->path());
    static_cast<void>(kept());  // the pages are written: nothing needs it any more
    unlink(scratch_->path().c_str());
    journal_->remove();
}

void TerrainStages::removeLeftovers(const std::string& scratchPath) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const std::string journalOf = journalPath(scratchPath);
    if (!fs::exists(fs::symlink_status(scratchPath, ignored)) &&
        !fs::exists(fs::symlink_status(journalOf, ignored)))
        return;
    const absl::StatusOr<ImportJournal> journal = ImportJournal::open(journalOf, 0, true);
    if (!journal.ok() && !absl::IsResourceExhausted(journal.status()))
        return;  // another's
    unlink(scratchPath.c_str());
    unlink(journalOf.c_str());
}

}  // namespace eyrie::import
