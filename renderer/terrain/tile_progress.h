// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string_view>

#include <absl/status/status.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/scratch.h"

namespace eyrie::terrain {

/// Where a pass over all tiles begins. What the pass before used last is still in memory where not
/// all fits, so each begins where the one before it ended.
enum class Sweep { FromFirstRow, FromLastRow };

/// Calls work(x, y) for all tiles, row by row, on all of TBB's threads; reports as `stage`. Stops
/// early when the import is called off or the scratch fails, and says so.
template <typename Work>
absl::Status forEachTile(std::int32_t tilesX, std::int32_t tilesY, std::string_view stage,
                         const Scratch& scratch, const import::ImportControl& control, Work work,
                         Sweep sweep = Sweep::FromFirstRow) {
    const std::int64_t count = std::int64_t{tilesX} * tilesY;
    const std::int64_t perReport = std::max<std::int64_t>(1, count / 200);
    std::int64_t done = 0;
    std::mutex doneMutex;
    std::atomic<bool> stops = false;
    std::atomic<std::int64_t> next = 0;  // in order, so that neighbours are worked on together
    control.report(stage, 0);
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, 1), [&](const auto& range) {
        for (std::int64_t k = range.begin(); k < range.end() && !stops; ++k) {
            const std::int64_t place = next++;
            const std::int64_t tile = sweep == Sweep::FromFirstRow ? place : count - 1 - place;
            work(static_cast<std::int32_t>(tile % tilesX),
                 static_cast<std::int32_t>(tile / tilesX));
            const std::lock_guard lock(doneMutex);
            if (++done % perReport != 0)
                continue;
            control.report(stage, static_cast<double>(done) / static_cast<double>(count));
            if (!control.check().ok() || !scratch.status().ok())
                stops = true;
        }
    });
    if (absl::Status status = scratch.status(); !status.ok())
        return status;
    if (absl::Status status = control.check(); !status.ok())
        return status;
    control.report(stage, 1);
    return absl::OkStatus();
}

}  // namespace eyrie::terrain
