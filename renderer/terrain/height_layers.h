// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <absl/status/status.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/tiled_raster.h"

namespace eyrie::terrain {

/// An elevation model's heights with posts left out: layer k has every 2^k th column and row, and
/// the last ones where those are no multiple. Layer 0 is the model's own raster. The rest lies on
/// scratch.
class HeightLayers {
public:
    /// Reserves its room; keeps a reference to `model`.
    HeightLayers(const ElevationModel& model, Scratch& scratch, int layers);

    /// Parallel; stage "thinning". Errors: Cancelled, the scratch's.
    absl::Status make(const import::ImportControl& control);

    const TiledRaster<float>& layer(int k) const {
        return k == 0 ? model_.heights : thinned_[static_cast<std::size_t>(k - 1)];
    }

private:
    const ElevationModel& model_;
    Scratch& scratch_;
    std::vector<TiledRaster<float>> thinned_;
};

}  // namespace eyrie::terrain
