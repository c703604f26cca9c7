// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "renderer/terrain/deviation.h"

namespace eyrie::test {

/// A grid as a model on a scratch.
class GridModel {
public:
    /// Spills to `path` beyond `budgetBytes`.
    explicit GridModel(const terrain::HeightGrid& grid, const std::string& path = "/nowhere",
                       std::uint64_t budgetBytes = std::numeric_limits<std::uint64_t>::max());

    const terrain::ElevationModel& model() const { return model_; }
    terrain::Scratch& scratch() { return scratch_; }
    terrain::SourceSurface& surface() { return surface_; }

private:
    terrain::Scratch scratch_;
    terrain::ElevationModel model_;
    terrain::SourceSurface surface_;
};

}  // namespace eyrie::test
