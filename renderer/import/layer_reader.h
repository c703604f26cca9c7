// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "renderer/import/layered_dems.h"
#include "renderer/terrain/tiled_raster.h"

namespace eyrie::import {

/// Posts of a layer, from its box's first, a window at a time. One thread at a time.
///
/// What it covers it says as it is. Heights come from the layer with its rim where that may tell
/// something else, which is looked for block by block: to resample all twice would take twice as
/// long.
class LayerReader {
public:
    explicit LayerReader(DemLayer layer);

    const DemLayer& layer() const { return layer_; }
    /// The heights of a window that lies in its box, row by row; what is no height is NaN or
    /// beyond 1e30. Errors: DataLoss.
    absl::Status read(const terrain::PostRect& window, std::vector<float>& out);

private:
    /// What is known of a block.
    struct Block {
        std::optional<bool> hasGaps;
        std::optional<bool> isBesideRim;
    };

    Block& blockOf(int x, int y);
    absl::StatusOr<bool> isBesideRim(int x, int y);
    absl::StatusOr<bool> hasGaps(int x, int y);
    absl::Status readPosts(GDALDatasetH posts, const terrain::PostRect& window,
                           std::vector<float>& out) const;

    DemLayer layer_;
    std::vector<Block> blocks_;  ///< none where nothing lies beside the layer
    std::vector<float> rimmed_;
};

}  // namespace eyrie::import
