// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/shown_triangles.h"

#include <algorithm>

#include "renderer/mesh/eym_format.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/truth/drawn_mesh.h"
#include "renderer/truth/drawn_terrain.h"

namespace eyrie::cli::bench {
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
    for (const ReferenceScene::Object& object : scene_.objects) {
        add(object);
        ends_.push_back(triangles_.size());
    }
    surface_.emplace(triangles_, camera_);
}

std::optional<truth::DrawnPoint> ShownTriangles::at(double x, double y, double depthMetres) {
    std::call_once(isRead_, [this] { read(); });
    const auto found = surface_->at(x, y, depthMetres);
    if (!found)
        return std::nullopt;
    const auto object = std::ranges::upper_bound(ends_, found->triangle);
    return truth::DrawnPoint{found->point, static_cast<std::size_t>(object - ends_.begin()),
                             found->mayHaveDepth, found->isAtEnd};
}

}  // namespace eyrie::cli::bench
