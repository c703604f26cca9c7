// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/shown_terrain.h"

#include <cmath>
#include <utility>

#include "renderer/terrain/eyt_format.h"

namespace eyrie::cli::bench {
namespace {

/// As truth::TerrainPromise has it: an edge-on triangle covers pixels whose centres it misses by up
/// to what its corners are rounded to.
constexpr double kReachPixels = 1.0 / 128;

}  // namespace

void ShownTerrain::read() {
    drawn_.emplace();
    for (const ReferenceScene::Object& object : scene_.objects) {
        if (!object.source.terrain)
            continue;
        const auto file = terrain::EytFile::open(object.imported, remote_);
        if (!file.ok())
            continue;
        auto drawn = truth::DrawnTerrain::of(**file, view_, tauPixels_, object.worldFromObject);
        if (drawn.ok())
            drawn_->push_back(*std::move(drawn));
    }
}

std::optional<fabric::Vec3> ShownTerrain::at(double x, double y, double depthMetres) {
    if (!drawn_)
        read();
    std::optional<truth::DrawnTerrain::Shown> best;
    for (const truth::DrawnTerrain& terrain : *drawn_) {
        const auto shown = terrain.shownAt(camera_, x, y, depthMetres, kReachPixels);
        if (shown && (!best || std::abs(shown->depthAtPoint - depthMetres) <
                                   std::abs(best->depthAtPoint - depthMetres)))
            best = shown;
    }
    return best ? std::optional(best->point) : std::nullopt;
}

}  // namespace eyrie::cli::bench
