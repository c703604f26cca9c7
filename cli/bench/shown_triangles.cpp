// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/shown_triangles.h"

#include "renderer/mesh/eym_format.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/truth/drawn_mesh.h"
#include "renderer/truth/drawn_terrain.h"
#include "renderer/truth/drawn_triangles.h"

namespace eyrie::cli::bench {
namespace {

/// As truth::TerrainPromise has it: an edge-on triangle covers pixels whose centres it misses by up
/// to what its corners are rounded to.
constexpr double kReachPixels = 1.0 / 128;

}  // namespace

void ShownTriangles::add(const ReferenceScene::Object& object) {
    if (object.source.terrain) {
        const auto file = terrain::EytFile::open(object.imported, remote_);
        if (!file.ok())
            return;
        const auto drawn =
            truth::DrawnTerrain::of(**file, view_, tauPixels_, object.worldFromObject);
        if (drawn.ok())
            triangles_.insert(triangles_.end(), drawn->triangles().begin(),
                              drawn->triangles().end());
        return;
    }
    const auto file = mesh::EymFile::open(object.imported, remote_);
    if (!file.ok())
        return;
    const auto drawn = truth::drawnTriangles(*file, view_, tauPixels_, object.worldFromObject);
    if (drawn.ok())
        triangles_.insert(triangles_.end(), drawn->begin(), drawn->end());
}

void ShownTriangles::read() {
    isRead_ = true;
    for (const ReferenceScene::Object& object : scene_.objects) add(object);
}

std::optional<fabric::Vec3> ShownTriangles::at(double x, double y, double depthMetres) {
    if (!isRead_)
        read();
    const auto shown = truth::shownAt(triangles_, camera_, x, y, depthMetres, kReachPixels);
    return shown ? std::optional(shown->point) : std::nullopt;
}

}  // namespace eyrie::cli::bench
