// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "cli/bench/reference_sources.h"
#include "renderer/lod/view.h"
#include "renderer/page/page_source.h"
#include "renderer/truth/drawn_terrain.h"

namespace eyrie::cli::bench {

/// The drawn points of one picture's terrains, for the few pixels whose depth alone does not tell
/// them (truth::Suspects): read from the imports when the first is asked for. All that is given is
/// referred to.
class ShownTerrain {
public:
    ShownTerrain(const ReferenceScene& scene, const truth::Pinhole& camera, const lod::View& view,
                 double tauPixels, const page::SourceOptions& remote)
        : scene_(scene), camera_(camera), view_(view), tauPixels_(tauPixels), remote_(remote) {}

    /// Nothing where no terrain covers the picture point, or the import cannot be read.
    std::optional<fabric::Vec3> at(double x, double y, double depthMetres);

private:
    void read();

    const ReferenceScene& scene_;
    const truth::Pinhole& camera_;
    const lod::View view_;
    const double tauPixels_;
    const page::SourceOptions& remote_;
    std::optional<std::vector<truth::DrawnTerrain>> drawn_;
};

}  // namespace eyrie::cli::bench
