// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

namespace eyrie::import {

/// Which steps of a long job are done, in a file that is there for as long as the job is not: each
/// with what has to be known to go on after it, and how large the file of the steps' results was by
/// then. Checksummed record by record, so what a crash cut short counts as never written. Held by
/// one process at a time.
class ImportJournal {
public:
    /// Opens or makes the file. Records are of use only for the same `key`, which stands for all
    /// that the job's result depends on; with another, or `startsOver`, they are dropped.
    /// Errors: FailedPrecondition (another process holds it), NotFound, PermissionDenied,
    /// ResourceExhausted, Unavailable.
    static absl::StatusOr<ImportJournal> open(const std::string& path, std::uint64_t key,
                                              bool startsOver);

    ImportJournal(ImportJournal&& other) noexcept;
    ImportJournal& operator=(ImportJournal&&) = delete;
    ~ImportJournal();

    /// What a step left when it was done before this run; null: it was not.
    const std::vector<std::byte>* find(std::uint32_t step) const;
    /// Lets go of the memory of what `find` gave for a step.
    void release(std::uint32_t step) { steps_.erase(step); }
    bool isEmpty() const { return steps_.empty(); }
    /// How many bytes of results the last step counts on that was done before this run.
    std::uint64_t resultBytes() const;
    /// Forgets what was done before this run from a step on: it is to be done again, and whatever
    /// came of it before holds no longer.
    absl::Status dropFrom(std::uint32_t step);
    /// Steps are added in ascending order. On disk when this returns.
    absl::Status add(std::uint32_t step, std::span<const std::byte> state,
                     std::uint64_t resultBytes);
    /// Forgets all steps.
    absl::Status clear();
    /// Deletes the file: the job is done.
    void remove();

private:
    ImportJournal(std::string path, int fd, std::uint64_t key)
        : path_(std::move(path)), fd_(fd), key_(key) {}

    void read();
    absl::Status append(std::span<const std::byte> bytes);

    std::string path_;
    int fd_;
    std::uint64_t key_;
    struct Step {
        std::uint64_t offset = 0;  ///< of its record
        std::uint64_t resultBytes = 0;
        std::vector<std::byte> state;
    };
    std::map<std::uint32_t, Step> steps_;
};

}  // namespace eyrie::import
