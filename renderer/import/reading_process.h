// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// What reading one file may cost.
struct ReadingLimits {
    std::uint64_t memoryBytes = 1ULL << 30;  ///< besides what the process has already
    std::chrono::seconds processorTime{30};  ///< of one core
    bool isMemoryGiven = false;  ///< memoryBytes is what a person allows, not what sound files need

    /// A gigabyte and half a minute, and more for large files: what real ones need ten times over.
    /// Where `mostMemory` is not 0, no more memory than that.
    static ReadingLimits forFile(std::uint64_t bytes, std::uint64_t mostMemory = 0);
    /// What it takes to decode the largest, and to keep so many as they are coded.
    static ReadingLimits forTextures(std::size_t count);
};

/// Calls `read` in a process of its own, a copy of this one, and brings back what it returns.
///
/// For libraries that a damaged file can make crash, loop or take all memory: whatever happens to
/// the copy, this process has a status. `read` must start no threads and need none that run here.
/// Nothing that it prints is seen.
/// Errors: those of `read`; InvalidArgument (it crashed), ResourceExhausted (memory or time),
/// Cancelled.
absl::StatusOr<TriangleMesh> readInOwnProcess(
    const std::function<absl::StatusOr<TriangleMesh>()>& read, const ReadingLimits& limits,
    const ImportControl& control);

}  // namespace eyrie::import
